# meso-map: the same bytes for any number of threads, from files and from the
# model, to a file and through a pipe; what it refuses, and that nothing stays.
cp "$fixtures"/vase.* .

three='vase.tiles.json vase.obj vase.slots'
for kind in meso ply obj glb drc; do
    meso-map -q --threads 1 $three -o "x.$kind"
    mv "x.$kind" "first.$kind"
    meso-map -q --threads 3 $three -o "x.$kind"
    cmp "first.$kind" "x.$kind"
done
meso-map -q --divisions 7 --section-step 0.1 $three -o x.meso
meso-map -q x.meso -o again.ply
meso-map -q --to ply x.meso -o - | tail -c 100000 >piped
tail -c 100000 again.ply | cmp - piped
draco_decoder -i x.drc -o decoded.ply >decoder.log || cat decoder.log
rm decoder.log decoded.ply
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
refuse --to stl vase.meso
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
