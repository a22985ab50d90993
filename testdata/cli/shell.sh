# Shells: normals, sides and heights, by attributes and by names; the same through a model; what folds is told and limited.
cp "$fixtures"/vase.tiles.json "$fixtures"/vase.obj "$fixtures"/vase.slots .
three='vase.tiles.json vase.obj vase.slots'
body() {
    tail -c 20000000
}
# Each of these is another mesh, and the same one through a model.
meso-map -q $three -o plain.ply
body <plain.ply >before
while read -r options; do
    meso-map $options $three -o x.ply
    meso-map -q $options $three -o x.meso
    body <x.ply >now
    meso-map -q x.meso --to ply -o - | body | cmp - now
    cmp -s before now && echo "$options: the same as before"
    mv now before
done <<END
--normals smooth
--normals flat
--side both
--side inside
--thickness 2
--thickness 2 --limit-folds
END
meso-map -q --limit-folds $three -o limited.ply     # which needs no limit
body <plain.ply >before
body <limited.ply | cmp - before

# Names of groups, and what is missing.
awk '/^f/ && !n++ {print "g foot"} n == 60 && /^f/ {print "g rim"} {print}' vase.obj >grouped.obj
meso-solve -q --seed 1 vase.tiles.json grouped.obj -o grouped.slots
grouped='vase.tiles.json grouped.obj grouped.slots'
meso-map -q --thickness-by group:rim=0.5 --offset-by group:foot=0.01 $grouped -o x.ply
meso-map -q --thickness-by group:rim=0.5 --offset-by group:foot=0.01 $grouped -o x.meso
body <x.ply >now
meso-map -q x.meso --to ply -o - | body | cmp - now
cmp -s before now && echo "heights do nothing"
for what in group rim group:top=1 group:rim=0; do
    meso-map -q --thickness-by $what $grouped -o y.ply || echo "status $?"
done
meso-map -q --offset-by group:rim=1 x.meso -o y.ply || echo "status $?"
[ -e y.ply ] && echo "y.ply is there"
meso-map -q --json=report.json --thickness 2 $three -o x.ply
grep folded_slots report.json
