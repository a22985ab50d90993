# Strands of meshes: numbered and measured, as one mesh each, closed where a border cuts them; as curves.
cp "$fixtures"/vase.* "$testdata/cli/quad.tiles.json" .
awk 'BEGIN { n = 6
    for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) print "v", i, 0.3 * sin(i + j), j
    for (j = 0; j < n; j++) for (i = 0; i < n; i++) { a = j * (n + 1) + i + 1; print "f", a, a + n + 1, a + n + 2, a + 1 } }' >grid.obj
meso-solve -q quad.tiles.json grid.obj -o grid.slots
meso-map -q --divisions 4 --section-step 0.2 quad.tiles.json grid.obj grid.slots -o grid.meso

facts() { meso-mesh info "$1" | grep -oE '"(components|border_loops|disagreeing_edges|crowded_edges|closed|inside_out)": [a-z0-9]*' | tr '\n' ' '; echo; }
for how in '' --cap-borders --weld '--weld --cap-borders'; do
    for model in grid vase; do
        # shellcheck disable=SC2086
        meso-map -q $how --json=report $model.meso -o $model.ply
        echo "$model $how: $(grep -oE '"strands": [0-9]*' report) $(facts $model.ply)"
    done
done

# Rings at ends without the points that only the other end needs: a disc and a box, by a tolerance.
cat >mixed.tiles.json <<END
{"format": "meso-tiles", "version": 1,
 "interfaces": [{"name": "a", "sections": [{"name": "1", "shape": {"disc": {"center": [0.5, 0.5], "size": [0.3, 0.3]}}}]},
  {"name": "b", "sections": [{"name": "1", "shape": {"box": {"center": [0.5, 0.5], "size": [0.2, 0.3]}}}]}],
 "tiles": [{"name": "t", "sides": ["a", "b", "a'", "b'"],
   "sweeps": [{"from": "0/1", "to": "1/1"}, {"from": "2/1", "to": "3/1"}]}]}
END
meso-solve -q mixed.tiles.json grid.obj -o mixed.slots
for how in --weld --cap-borders '--weld --cap-borders'; do
    # shellcheck disable=SC2086
    meso-map -q --tolerance 0.01 $how mixed.tiles.json grid.obj mixed.slots -o mixed.ply
    meso-mesh -q weld info mixed.ply -o mixed.obj | grep -oE '"(components|border_loops|closed|inside_out)": [a-z0-9]*' |
        tr '\n' ' '
    echo "$how"
done

# The same number in each kind of file, with its length; and read back.
meso-map -q grid.meso -o grid.ply
grep -a '^comment strand_length 0' grid.ply
meso-map -q grid.meso -o grid.obj2 --to obj
grep '^# strand_length 0' grid.obj2
meso-map -q grid.meso -o grid.glb
strings -n 100 grid.glb | head -n 1 | grep -o '"strand_lengths":\[[^,]*,'
meso-map -q grid.meso -o grid.drc
strings grid.drc | grep -o 'strand_lengths.*' | cut -c 1-24
for kind in ply glb drc; do
    meso-mesh info grid.$kind | grep '"name": "strand"'
done
meso-map -q grid.meso -o grid.usda
grep -c 'def BasisCurves' grid.usda
for threads in 1 2 7; do
    for kind in ply usda glb; do
        meso-map -q --threads $threads --weld --cap-borders vase.meso --to $kind -o - | cksum
    done
done | sort -u | wc -l
meso-map --weld grid.meso -o x.meso || echo "$?"
meso-map --cap-borders grid.meso -o x.meso || echo "$?"
meso-map --weld --slots 0-3 grid.meso -o x.ply || echo "$?"
meso-map -q --weld --shard 2/3 grid.meso -o x.ply && facts x.ply
