# Motion to the next frame: of a camera that turns, of a model that swells, of one whose structure changes, and at the end.
cp "$fixtures/vase.meso" "$fixtures/vase.slots" "$fixtures/vase.obj" "$fixtures/vase.tiles.json" .
render() { meso-render --size 60x50 --samples 1 --aov motion "$@"; }
# What there is of motion in a picture, in pixels.
most() {
    oiiotool "$1" --ch forward.u,forward.v --abs --printstats | sed -n 's/.*Stats Max: \([0-9.]*\) \([0-9.]*\) .*/\1 \2/p'
}
is_over() { most "$1" | awk '{print ($1 > 0.2), ($2 > 0.2)}'; }
render -q --turntable 60 --frames 3,60 vase.meso -o turn-%d.exr
is_over turn-3.exr
is_over turn-60.exr
cp turn-3.exr alone.exr
render -q --turntable 60 --frames 3 --band-rows 16 vase.meso -o turn-%d.exr
cmp turn-3.exr alone.exr
cat >vase.camera.json <<END
{"format": "meso-camera", "version": 1, "keys": [
  {"frame": 1, "eye": [0, 1, 4], "target": [0, 0.5, 0]}, {"frame": 3, "eye": [0.4, 1.4, 4]}]}
END
render -q --keys vase.camera.json --frames 2,3 vase.meso -o key-%d.exr
is_over key-2.exr
most key-3.exr

for number in 1 2; do
    meso-map -q --thickness 0.3$number vase.tiles.json vase.obj vase.slots -o swell-$number.meso
done
meso-solve -q --seed 9 vase.tiles.json vase.obj -o other.slots
meso-map -q --thickness 0.3 vase.tiles.json vase.obj other.slots -o swell-3.meso
render --eye 0,1,4 --target 0,0.5,0 swell-%d.meso -o swell-%d.exr
most swell-1.exr | awk '{print ($1 > 0.01 && $1 < 1), ($2 > 0.01 && $2 < 1)}'
most swell-2.exr
most swell-3.exr
exrheader swell-1.exr | grep -o '"name":"swell-[0-9].meso"'
# A next frame that changes makes the picture anew; one that is the same does not.
render --eye 0,1,4 --target 0,0.5,0 --frames 1 --resume swell-%d.meso -o swell-%d.exr
cp swell-3.meso swell-2.meso
render --eye 0,1,4 --target 0,0.5,0 --frames 1 --resume swell-%d.meso -o swell-%d.exr

render vase.meso -o no.exr
echo "status $?"
render --visibility gl --turntable 2 vase.meso -o no-%d.exr
echo "status $?"
render -q --aov all vase.meso -o all.exr
exrheader all.exr | grep -c forward
render -q --aov all,motion --multipart --turntable 4 --frames 1 vase.meso -o all-%d.exr
exrheader all-1.exr | grep '^name.*forward'
