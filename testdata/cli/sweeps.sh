# Sweeps: frames, sizes of sections, tolerances; whole turns and tangent scales of a tile set; the same through a model.
cp "$fixtures"/vase.tiles.json "$fixtures"/vase.obj "$fixtures"/vase.slots .
three='vase.tiles.json vase.obj vase.slots'
ply() {
    meso-map -q --provenance none --to ply "$@" -o -
}
# Each of these is another mesh, the same one for any number of threads, and through a model.
ply $three >plain
cp plain before
while read -r options; do
    ply --threads 1 $options $three >now
    ply --threads 3 $options $three | cmp - now
    meso-map -q $options $three -o x.meso
    ply x.meso | cmp - now
    cmp -s before now && echo "$options: the same as before"
    mv now before
done <<END
--frame minimal
--section-size slot
--tolerance 0.02
--tolerance 0.005
--tolerance 0.005u
--tolerance 0.005 --frame minimal --section-size slot
END
meso-info x.meso | grep -E '"(frame|section_size|tolerance)'

# Divisions put an end to a tolerance.
meso-map -q --tolerance 0.01 $three -o x.meso
ply --divisions 12 x.meso | cmp - plain

# Fewer triangles for the same look; a picture of each kind.
for tolerance in 0.02 0.002; do
    meso-map -q --tolerance $tolerance --json=report.json $three -o x.glb
    sed -n 's/.*"triangles": \([0-9]*\).*/\1/p' report.json
done >counts
sort -c -n counts
meso-render -q --size 32x32 x.meso -o x.png

for tolerance in 0 2 x 1e-9 0.1v -1u; do
    meso-map -q --tolerance=$tolerance $three -o y.ply || echo "status $?"
done
meso-map -q --tolerance 0.1 --divisions 4 $three -o y.ply || echo "status $?"
[ -e y.ply ] && echo "y.ply is there"

# What a tile set says of its own sweeps.
sed 's/"to": "[^"]*"/&, "turns": 1, "tangent_scale": 0.5/' vase.tiles.json >turning.tiles.json
cmp -s vase.tiles.json turning.tiles.json && echo "no sweep turns"
meso-tile check -q turning.tiles.json
meso-solve -q --seed 1 turning.tiles.json vase.obj -o turning.slots
ply turning.tiles.json vase.obj turning.slots >now
cmp -s now plain && echo "turns do nothing"
sed 's/"turns": 1/"turns": 65/' turning.tiles.json >wrong.tiles.json
meso-tile check -q wrong.tiles.json 2>&1 | head -n 1
rm -f ./*
