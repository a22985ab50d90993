# Weights that follow a property of the surface, with every engine; seeds' lines know one ramp from another.
cp "$fixtures/vase.tiles.json" .
awk '$1 == "v" { v[++n] = $2 " " $3 " " $4 " " $3 }
    $1 == "f" { f[++m] = "4"; for (i = 2; i <= 5; i++) f[m] = f[m] " " $i - 1 }
    END {
        print "ply\nformat ascii 1.0\nelement vertex " n "\nproperty float x\nproperty float y\nproperty float z"
        print "property float height\nelement face " m "\nproperty list uchar int vertex_indices\nend_header"
        for (i = 1; i <= n; i++) print v[i]
        for (i = 1; i <= m; i++) print f[i]
    }' "$fixtures/vase.obj" >vase.ply
loops() {
    printf '{"format": "meso-constraints", "version": 1, "weights": {"reed loops": %s}}\n' "$2" >"$1.json"
}
ramp='{"property": "height", "stops": %s}'
loops none 0
loops many 1000
# Beyond the stops on either side, and from one side to the other.
loops low "$(printf "$ramp" '[[1000, 0], [2000, 1000]]')"
loops high "$(printf "$ramp" '[[-2000, 0], [-1000, 1000]]')"
loops rise "$(printf "$ramp" '[[0, 0], [3, 30]]')"
for engine in auto wfc exact; do
    for weights in none many low high rise; do
        meso-solve -q --engine $engine --seed 2 --constraints $weights.json vase.tiles.json vase.ply -o $engine-$weights.slots
        meso-info $engine-$weights.slots | grep -o '"reed loops": [0-9]*' >$engine-$weights.txt
    done
    cmp $engine-none.txt $engine-low.txt
    cmp $engine-many.txt $engine-high.txt
    echo $engine $(cat $engine-none.txt $engine-rise.txt $engine-many.txt)
done

meso-solve -q --seeds 1-2 --constraints low.json vase.tiles.json vase.ply -o low.jsonl
meso-solve --seeds 1-3 --resume low.jsonl --constraints high.json vase.tiles.json vase.ply -o high.jsonl || echo "resume: $?"
loops wrong "$(printf "$ramp" '[[1, 0], [0, 1000]]')"
meso-solve --constraints wrong.json vase.tiles.json vase.ply -o no.slots || echo "wrong: $?"
meso-solve --constraints rise.json vase.tiles.json "$fixtures/vase.obj" -o no.slots || echo "no property: $?"
test ! -e no.slots
