# meso-map: the same bytes for any number of threads, from files and from the
# model, to a file and through a pipe; what it refuses, and that nothing stays.
cp "$fixtures"/vase.* .

three='vase.tiles.json vase.obj vase.slots'
for kind in meso ply obj glb drc stl; do
    meso-map -q --threads 1 $three -o "x.$kind"
    mv "x.$kind" "first.$kind"
    meso-map -q --threads 3 $three -o "x.$kind"
    cmp "first.$kind" "x.$kind"
done
meso-map -q --divisions 7 --section-step 0.1 $three -o x.meso
meso-map -q x.meso -o again.ply
meso-map -q --to ply x.meso -o - | tail -c 100000 >piped
tail -c 100000 again.ply | cmp - piped
for kind in ply obj; do
    draco_decoder -i x.drc -o decoded.$kind >decoder.log || cat decoder.log
done
rm decoder.log decoded.*

# A file of materials goes with an OBJ that has a name; both or neither.
grep -c '^usemtl' x.obj
grep '^usemtl' x.obj | sort -u | cut -d ' ' -f 2 >used
grep '^newmtl' x.mtl | sort -u | cut -d ' ' -f 2 | comm -13 - used
grep '^mtllib' x.obj
rm x.obj x.mtl
mkdir x.mtl
meso-map -q vase.meso -o x.obj || echo "$? $(ls x.obj 2>/dev/null)"
rmdir x.mtl
meso-map -q --to obj vase.meso -o - | grep -c '^mtllib'
meso-map -q vase.obj -o x.obj
cp x.obj vase.mtl
meso-map -q vase.mtl vase.obj vase.slots -o vase.obj || echo "$?"
cmp x.obj vase.mtl

# Compressed, the same triangles; turned and scaled, the same tree below another root.
meso-map -q --compress draco vase.meso -o draco.glb
meso-map -q --up z --unit 0.01 vase.meso -o turned.glb
meso-map -q vase.meso -o plain.glb
for file in plain draco turned; do
    meso-mesh info $file.glb | grep '"triangles"'
    strings -n 100 $file.glb | head -n 1 | grep -o '"nodes":\[{[^}]*\[1,'
done
meso-map -q --json vase.meso -o report.ply | grep -E '^  "(kind|slots|parts)"'

refuse() {
    status=0
    meso-map "$@" -o refused 2>err >out || status=$?
    echo "$status $(head -n 1 err)"
    [ ! -s out ] && [ ! -e refused ] || echo "something was written"
}
refuse --to ply
refuse --to ply vase.tiles.json vase.obj
refuse --to ply --speed 3 vase.meso
refuse --to ply --mesh-path . vase.meso
refuse --to ply --divisions 1 vase.meso
refuse --to stp vase.meso
refuse --to stl --compress draco vase.meso
refuse --to ply --up z vase.meso
refuse --to glb --position-bits 9 vase.meso
refuse vase.meso
refuse --to ply vase.slots
refuse --to ply missing.meso
refuse --to ply .
sed '$d' vase.obj >short.obj
refuse --to ply vase.tiles.json short.obj vase.slots
head -c 1000 vase.slots >cut.slots
refuse --to ply vase.tiles.json vase.obj cut.slots
status=0
meso-map vase.meso -o missing/x.ply 2>err || status=$?
echo "$status $(cat err)"
status=0
meso-map vase.meso --to obj -o /dev/full 2>err || status=$?
echo "$status $(cat err)"
find . -name '.*.tmp'
