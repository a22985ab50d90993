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

# Of other programs: the same camera in each.
cat >scene.gltf <<END
{"asset": {"version": "2.0"}, "cameras": [{"name": "wide", "type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}},
  {"name": "flat", "type": "orthographic", "orthographic": {"xmag": 3, "ymag": 1.5, "znear": 0.1, "zfar": 100}}],
 "nodes": [{"name": "near", "translation": [0, 1, 4], "camera": 0}, {"name": "front", "translation": [0, 1, 4], "camera": 1}]}
END
zero='\0\0\0\0' one='\0\0\200\077'
printf "$one$zero$zero$zero$zero$one$zero$zero$zero$zero$one$zero$zero"'\0\0\200\277\0\0\200\300'"$one" >view.bin
cat view.bin view.bin >views.bin
at='--eye 0,1,4 --target 0,1,0 --provenance none'
meso-render $small --camera scene.gltf --provenance none --json=file.json vase.meso -o file.png
meso-render $small $at --fov 57.29577951308232 vase.meso -o given.png
cmp file.png given.png
meso-render $small --camera scene.gltf:front --provenance none vase.meso -o file.png
meso-render $small $at --ortho 3 vase.meso -o given.png
cmp file.png given.png
meso-render $small $at --fov 40 vase.meso -o given.png
for camera in scene.gltf:flat views.bin:2 view.bin; do
    meso-render $small --camera $camera --fov 40 --provenance none vase.meso -o file.png
    cmp file.png given.png
done
meso-render -q $small --keys views.bin --fov 40 --provenance none vase.meso -o view-%d.png
cmp view-1.png given.png
cmp view-2.png given.png
# What is up in the world is not what is up for the camera.
meso-render $small --camera scene.gltf --ground shadow --provenance none vase.meso -o file.png
meso-render $small $at --fov 57.29577951308232 --ground shadow vase.meso -o given.png
cmp file.png given.png
meso-render $small --camera scene.gltf --ground shadow --up 0,1,-0.5 --provenance none vase.meso -o file.png
cmp -s file.png given.png && echo "the ground stays level"
grep -A5 '"camera": {' file.json
meso-render -q $small --camera scene.gltf:near --json vase.meso -o file.png | grep -A1 -E '"(role": "camera|command": "meso-render)'

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
refuse --camera scene.gltf:side
refuse --camera scene.gltf --eye 1,2,3
refuse --camera views.bin:3
refuse --camera vase.meso
refuse --camera scene.gltf --keys ortho.camera.json
head -c 100 views.bin >cut.bin
refuse --camera cut.bin
meso-render $small --ortho 0 --keys ortho.camera.json vase.meso -o x-%d.png || echo "status $?"
ls x* 2>/dev/null
true
