# Sections that deform with their slots: another mesh, the same for any number of threads and through a model; closed and
# without gaps, welded, by a tolerance, in every file; inner meshes that meet; pictures by both renderers.
cp "$fixtures"/vase.tiles.json "$fixtures"/vase.obj "$fixtures"/vase.slots .
three='vase.tiles.json vase.obj vase.slots'
ply() {
    meso-map -q --provenance none --to ply "$@" -o -
}
found() {
    meso-check --fast --max-faults 999999 "$1" 2>&1 | grep -E '^(gap|open|leak|inverted|pinch|inside-out) ' | grep -vE ' (0|not) '
}
ply $three >before
while read -r options; do
    ply --threads 1 --deform shape $options $three >now
    ply --threads 3 --deform shape $options $three | cmp - now
    meso-map -q --deform shape $options $three -o x.meso
    ply x.meso | cmp - now
    cmp -s before now && echo "$options: the same as before"
    found x.meso && echo "$options: faults"
    mv now before
done <<END
--divisions 12
--divisions 6 --frame minimal
--divisions 5 --side inside
--divisions 4 --normals flat
--tolerance 0.02
END
meso-info x.meso | grep '"deform"'
ply --deform curves --divisions 12 x.meso >now
ply --divisions 12 $three | cmp - now

# Each strand one mesh, and curves.
meso-map -q --deform shape --weld $three -o welded.ply
found welded.ply && echo "faults where strands are welded"
meso-mesh info welded.ply | grep -E '"(border_loops|closed)"'
meso-map -q x.meso -o x.usda
grep -c BasisCurves x.usda

# What lies in the sides of slots, whose neighbours are flat-shaded: one piece.
cat >sheet.obj <<END
v 0.25 0 0.1
v 0.75 0 0.1
v 0.75 1 0.1
v 0.25 1 0.1
f 1 2 3 4
END
cat >sheet.tiles.json <<END
{"format": "meso-tiles", "version": 1, "interfaces": [{"name": "a"}],
 "tiles": [{"name": "t", "sides": ["a", "a", "a'", "a'"], "inner": [{"mesh": "sheet.obj"}]}]}
END
awk 'BEGIN { for (i = 0; i <= 3; i++) print "v", i, 0, i * i / 4, "\nv", i, 1, i * i / 5
    print "vn -.24 0 .97\nvn -.6 0 .8\nvn -.78 0 .62"
    for (i = 0; i < 3; i++) printf "f %d//%d %d//%d %d//%d %d//%d\n", 2*i+1, i+1, 2*i+3, i+1, 2*i+4, i+1, 2*i+2, i+1 }' >strip.obj
meso-solve -q sheet.tiles.json strip.obj -o sheet.slots
for deform in curves shape; do
    meso-map -q --deform $deform sheet.tiles.json strip.obj sheet.slots -o sheet.ply
    meso-mesh -q weld info sheet.ply -o w.ply | grep '"components"'
done

for visibility in tiles gl; do
    meso-render -q --visibility $visibility --size 32x32 x.meso -o $visibility.png && [ -s $visibility.png ]
done
meso-map -q --deform shape --section-size slot $three -o y.ply || echo "status $?"
[ -e y.ply ] && echo "y.ply is there"
rm -f ./*
