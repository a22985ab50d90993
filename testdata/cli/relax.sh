# Relaxation: what it did, the same through a model and for any threads, done anew where the form changes, and undone.
cp "$fixtures"/vase.tiles.json "$fixtures"/vase.obj "$fixtures"/vase.slots .
three='vase.tiles.json vase.obj vase.slots'
body() {
    tail -c 20000000
}
meso-map -q $three -o plain.meso
meso-map -q plain.meso --to ply -o - | body >plain
meso-map --relax 8 --json=report.json $three -o relaxed.meso
grep -A 7 relaxed report.json
meso-info relaxed.meso | grep -e '"relax"' -e moved_joints
meso-info plain.meso | grep -e '"relax"' -e moved_joints
meso-map -q relaxed.meso --to ply -o - | body >relaxed
cmp -s plain relaxed && echo "nothing moved"
for threads in 1 2 7; do
    meso-map -q --relax 8 --threads $threads $three --to ply -o - | body | cmp - relaxed
done
meso-map -q --relax 8 plain.meso --to ply -o - | body | cmp - relaxed
meso-map -q --relax 0 relaxed.meso --to ply -o - | body | cmp - plain
meso-map -q --divisions 5 relaxed.meso -o five.ply      # which does not relax anew
meso-map --thickness 0.5 relaxed.meso -o anew.ply
meso-map -q --relax 8 --thickness 0.5 $three -o other.ply
body <other.ply >other
body <anew.ply | cmp - other
meso-check --json=check.json relaxed.meso >/dev/null
grep -A 3 -e '"gap"' -e '"angle"' check.json | head -n 8
meso-map --relax 10001 $three -o x.meso || echo "status $?"
meso-map --deform shape relaxed.meso -o x.meso || echo "status $?"
