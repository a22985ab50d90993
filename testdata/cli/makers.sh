# Pictures beside each other: what meso-info says of their differences; tiles and OSMesa see the same vase.
model=$fixtures/vase.meso
render() { meso-render -q --size 240x300 --samples 1 "$@" "$model"; }
# field CHANNEL KEY
field() { tr -d ' \n' <beside.json | sed 's/{"name"/\n&/g' | sed -n "s/^{\"name\":\"$1\".*\"$2\":\([^,}]*\).*/\1/p"; }

render --visibility tiles -o tiles.exr
render --visibility gl -o gl.exr
render --visibility tiles --eye 0,2,9 -o other.exr

echo "== itself"
meso-info --compare tiles.exr tiles.exr | grep -c '"differing": 0,'

echo "== tiles and GL: ids differ in fewer than one pixel of a hundred, depths by less than a hundredth"
meso-info -q --compare tiles.exr gl.exr -o beside.json || echo "status $?"
for channel in slot tile; do
    awk -v n="$(field $channel differing)" 'BEGIN { print (n < 0.01 * 240 * 300) }'
done
awk -v n="$(field Z unlike)" -v r="$(field Z relative)" 'BEGIN { print (n < 0.005 * 240 * 300), (r < 0.01) }'

echo "== colour varies from strand to strand, and nothing else does"
render --vary 0.5 -o varied.exr
meso-info -q --compare tiles.exr varied.exr -o beside.json || echo "status $?"
for channel in R A slot Z N.X albedo.R; do
    awk -v n="$(field $channel differing)" 'BEGIN { print (n > 0) }'
done

echo "== GL finds what is seen for the same light"
for maker in tiles gl; do
    render --visibility $maker --light sky --ground shadow --vary 0.5 --aov all -o $maker.exr
done
meso-info -q --compare tiles.exr gl.exr -o beside.json || echo "status $?"
for channel in R G A AO P.X uv.U; do
    awk -v n="$(field $channel relative)" 'BEGIN { print (n < 0.1) }'
done

echo "== auto: tiles where no GPU is there, where a driver does not find it, and for frames that are resumed"
mkdir none gpu gpu/dri
: >gpu/dri/renderD128
render --visibility tiles --provenance none -o plain.exr
auto() { __EGL_VENDOR_LIBRARY_DIRS=$PWD/none meso-render -v --size 240x300 --samples 1 --provenance none "$@" "$model"; }
auto --devices none -o none.exr 2>&1 | grep -o 'drawn by.*'
auto --devices gpu -o gpu.exr 2>&1 | grep -c 'drawn by tiles: .*EGL'
auto --devices gpu --resume -o resumed.exr 2>&1 | grep -o 'drawn by.*'
for picture in none gpu resumed; do cmp plain.exr $picture.exr; done

echo "== from elsewhere"
meso-info -q --compare tiles.exr other.exr -o beside.json || echo "status $?"
awk -v n="$(field slot differing)" 'BEGIN { print (n > 0.1 * 240 * 300) }'

echo "== the worst pixel, what one alone has, sizes, words"
printf 'P' >no.png
meso-render -q --size 32x32 "$model" -o small.png
meso-render -q --size 32x32 --background none "$model" -o clear.png
meso-info --compare small.png clear.png | grep alone
meso-info --compare small.png tiles.exr
echo "status $?"
meso-info --compare no.png small.png
echo "status $?"
meso-info --compare small.png small.png clear.png
echo "status $?"
