# Cameras: a lens is a field of view, as an option and in a key; orthographic ones, with a height and as the model fits,
# by both makers; what does not fit together is refused.
cp "$fixtures"/vase.meso .
small='--size 48x32 --samples 1'
meso-render $small --focal 50 --provenance none vase.meso -o lens.png
meso-render $small --fov 26.9914665615516 --provenance none vase.meso -o view.png
cmp lens.png view.png
meso-render $small --focal 25 --sensor 18 --provenance none vase.meso -o half.png
cmp lens.png half.png

keys() {
    echo '{"format": "meso-camera", "version": 1, "keys": [{"frame": 1, "eye": [0, 1, 4], "target": [0, 0.5, 0], '"$1}]}"
}
keys '"focal": 50' >lens.camera.json
keys '"focal": 25, "sensor": 18' >half.camera.json
keys '"ortho": 3' >ortho.camera.json
for name in lens half ortho; do
    meso-render -q $small --keys $name.camera.json --provenance none vase.meso -o $name-%d.png
done
meso-render $small --focal 50 --eye 0,1,4 --target 0,0.5,0 --provenance none vase.meso -o lens.png
meso-render $small --ortho 3 --eye 0,1,4 --target 0,0.5,0 --provenance none vase.meso -o ortho.png
cmp lens.png lens-1.png
cmp lens.png half-1.png
cmp ortho.png ortho-1.png
cmp -s lens.png ortho.png && echo "the same"

meso-render $small --ortho 0 --json=fit.json vase.meso -o fit.exr
meso-render $small --ortho 0 --visibility gl --json=gl.json vase.meso -o gl.exr
for name in fit gl; do
    grep -E 'ortho|fov|command.*render' $name.json
done

refuse() {
    status=0
    meso-render $small "$@" vase.meso -o x.png || status=$?
    echo "status $status"
}
refuse --sensor 24
refuse --ortho 3 --fov 20
refuse --focal 50 --fov 20
refuse --focal 100000 --sensor 0.01
refuse --ortho -1
meso-render $small --ortho 0 --keys ortho.camera.json vase.meso -o x-%d.png || echo "status $?"
ls x* 2>/dev/null
true
