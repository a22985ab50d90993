# Grammars on surfaces: products, limits, seeds, threads, traces; and what cannot be.
cp "$fixtures"/*.grammar "$fixtures/crack.tiles.json" "$fixtures/paint.png" "$fixtures/vase.obj" .
try() { "$@"; echo "status $?"; }
grammar() { printf 'meso-grow 1\n%s\n' "$1"; }
count() { sed -n "s/.*\"$1\": \([0-9]*\).*/\1/p" "$2" | head -n 1; }

echo "== every grammar grows"
for name in ivy lace cracks scales feathers chains coral; do
    meso-grow -q $name.grammar vase.obj -o $name.meso --json=$name.json
    echo "$name: $? $(count seeds $name.json) seeds, $(count elements $name.json) elements"
done

"$generators/make_column" >column.obj
meso-grow -q painted.grammar column.obj -o painted.meso --json=painted.json
echo "painted: $? $(count seeds painted.json) seeds, $(count elements painted.json) elements"

meso-info lace.grammar | grep -v "bytes\|xxh3"

echo "== the page shows four of them as they are"
page() { mandoc -T ascii -O width=1000 "$testdata/../man/meso-grammar.5" | sed "s/.$(printf '\b')//g"; }
page >page.txt
for name in scales lace cracks ivy; do
    sed '/^$/d' $name.grammar | while IFS= read -r line; do grep -qF -e "$line" page.txt || echo "not there: $line"; done
done

echo "== kinds of products; the surface below"
for kind in ply obj glb drc svg; do
    meso-grow -q --until 3 ivy.grammar vase.obj -o ivy.$kind && test -s ivy.$kind && echo $kind
done
grep -c '<path' ivy.svg
meso-grow -q --until 3 --surface "clay #a8653f 0.7" ivy.grammar vase.obj -o with.meso --json=with.json
meso-info with.meso | grep "bodies\|materials"
try meso-grow -q --surface "clay #a8653" ivy.grammar vase.obj -o x.meso

echo "== the same bytes for any number of threads, and from one run to the next"
for threads in 1 2 7 2; do
    meso-grow -q --threads $threads lace.grammar vase.obj -o - --to ply | cksum
done | uniq | wc -l

echo "== seeds: each what it is alone"
meso-grow -q --until 9 --seeds 1-3,7 lace.grammar vase.obj -o lace-%d.ply --trace lace-%d.jsonl
ls lace-*.ply lace-*.jsonl
meso-grow -q --until 9 --seed 7 lace.grammar vase.obj -o alone.ply --trace alone.jsonl
cmp lace-7.ply alone.ply && cmp lace-7.jsonl alone.jsonl && cmp -s lace-1.ply lace-2.ply
echo $?
try meso-grow --seeds 1-3 lace.grammar vase.obj -o lace.ply
try meso-grow --seeds 1-3 lace.grammar vase.obj -o lace-%d.ply --trace t.jsonl
try meso-grow --seeds 1-3 --seed 2 lace.grammar vase.obj -o lace-%d.ply

echo "== a trace says what was done"
grammar 'shape s = tube  seed A() on at(0 m, 0 m, 2 m) face up
rule A() -> { step(0.1 m, shape: s, width: 0.02 m) if generation < 2 { A() } }' >two.grammar
meso-grow -q two.grammar vase.obj -o two.svg --trace two.jsonl
sed 's/"branch": "[0-9a-f]*"/"branch"/; s/"to": "[0-9a-f]*"/"to"/; s/ "at": \[[^]]*\]/ "at"/' two.jsonl
grep -c '<path' two.svg

echo "== parameters"
meso-grow -q --until 3 --set thick=0.01extent,pace=0.02extent ivy.grammar vase.obj -o set.meso
meso-grow -q --until 3 --set thick=0.01extent --set pace=0.02extent ivy.grammar vase.obj -o again.meso
cmp set.meso again.meso
try meso-grow --set thik=1mm ivy.grammar vase.obj -o x.meso
try meso-grow --set thick=3deg ivy.grammar vase.obj -o x.meso
try meso-grow --set thick ivy.grammar vase.obj -o x.meso

echo "== details of shapes: more faces, and the same growth"
for detail in 0 2; do
    meso-grow -q --until 9 --detail $detail ivy.grammar vase.obj -o detail.ply --json=detail-$detail.json
    echo "$(count elements detail-$detail.json) elements, $(sed -n 's/^element face //p' detail.ply) faces"
done
meso-grow -q --provenance none scales.grammar vase.obj -o own.meso
meso-grow -q --provenance none --detail 1 scales.grammar vase.obj -o told.meso
cmp own.meso told.meso && echo "as the grammar has it"
try meso-grow --detail 9 ivy.grammar vase.obj -o x.meso

echo "== growth without an end stops at its limits"
grammar 'shape s = tube  seed A() on poisson(1 extent)
rule A() -> { step(0.01 extent, shape: s, width: 0.001 extent, cross: true) branch { turn(90 deg) A() } A() }' >all.grammar
try meso-grow -q --elements 1000 all.grammar vase.obj -o all.ply
ls all.ply 2>/dev/null
try meso-grow -q --elements 1000 --partial all.grammar vase.obj -o all.ply
test -s all.ply && echo "written"
sed 's/seed/limit generations 4 seed/' all.grammar >four.grammar
try meso-grow -q four.grammar vase.obj -o four.ply
try meso-grow -q --until 4 four.grammar vase.obj -o four.ply

echo "== a single triangle, a one-sided band, two pieces"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >one-face.obj
awk 'BEGIN { n = 24; pi = atan2(0, -1)
    for (i = 0; i < n; i++) for (s = -1; s <= 1; s++) {
        a = 2 * pi * i / n; r = 1 + 0.3 * s * cos(a / 2)
        print "v", r * cos(a), r * sin(a), 0.3 * s * sin(a / 2) }
    for (i = 0; i + 1 < n; i++) for (k = 1; k < 3; k++) print "f", 3 * i + k, 3 * i + k + 3, 3 * i + k + 4, 3 * i + k + 1
    for (k = 1; k < 3; k++) print "f", 3 * n - 3 + k, 4 - k, 3 - k, 3 * n - 2 + k }' >band.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 1 2 3\nf 4 5 6\n' >two.obj
for surface in one-face band two; do
    meso-grow -q coral.grammar $surface.obj -o $surface.ply --json=$surface.json
    echo "$surface: $?, elements $(test "$(count elements $surface.json)" -gt 0 && echo some)"
done

echo "== what a grammar reads"
grammar 'map wet = attribute("damp")  shape s = leaf  seed A() on poisson(0.1 extent) where wet > 0.5
rule A() -> place s(0.02 extent)' >damp.grammar
try meso-grow damp.grammar vase.obj -o x.ply
grammar 'map paint = image("missing.png")  shape s = leaf  seed A() on poisson(0.1 extent) where paint > 0.5
rule A() -> place s(0.02 extent)' >paint.grammar
try meso-grow paint.grammar vase.obj -o x.ply
grammar 'shape s = mesh("missing.obj")  seed A() on poisson(0.1 extent)  rule A() -> place s(0.02 extent)' >mesh.grammar
try meso-grow mesh.grammar vase.obj -o x.ply
grammar 'shape s = mesh("one-face.obj", along: x, material: "red #f00")  seed A() on poisson(0.1 extent)
rule A() -> place s(0.02 extent)' >mesh.grammar
try meso-grow mesh.grammar vase.obj -o x.ply
sed -i 's/ #f00//' mesh.grammar
try meso-grow -q mesh.grammar vase.obj -o mesh.ply
grammar 'shape s = section("crack.tiles.json", "crak")  seed A() on poisson(0.1 extent)  rule A() -> place s(0.02 extent)' >name.grammar
try meso-grow name.grammar vase.obj -o x.ply
grammar 'shape s = leaf  seed A() on poisson(0.1 extent) where height < 0  rule A() -> place s(0.02 extent)' >none.grammar
try meso-grow none.grammar vase.obj -o x.ply
grammar 'shape s = leaf  seed A() on poisson(0.1 extent)  rule A() -> place s(1 extent / (generation - generation))' >zero.grammar
try meso-grow zero.grammar vase.obj -o x.ply

echo "== wrong usage"
try meso-grow ivy.grammar -o x.ply
try meso-grow vase.obj ivy.grammar -o x.ply
try meso-grow ivy.grammar vase.obj -o x.txt
try meso-grow ivy.grammar vase.obj -o ivy.grammar --to ply
try meso-grow --up 0,0,0 ivy.grammar vase.obj -o x.ply
try meso-grow --until 0 ivy.grammar vase.obj -o x.ply
ls x.* 2>/dev/null

echo "== maps as pictures; read again, they are the same maps"
for kind in png exr; do
    try meso-grow -q --show-map paint=shown.$kind painted.grammar column.obj -o a.meso
    sed "s/paint\.png/shown.$kind/" painted.grammar >again.grammar
    meso-grow -q again.grammar column.obj -o b.meso --json=again.json
    echo "$(count seeds painted.json) $(count seeds again.json) seeds"
done
meso-info shown.exr | grep channels
try meso-grow --show-map pain=x.png painted.grammar column.obj -o a.meso
try meso-grow --show-map paint painted.grammar column.obj -o a.meso
try meso-grow --show-map paint=painted.grammar painted.grammar column.obj -o a.meso

# On a fin, which has a surface on both sides, what lies too deep is raised by half of its length at most.
"$generators/make_body" fish >fish.obj
meso-grow -q "$testdata/grammars/scales.grammar" fish.obj -o fish.ply
meso-info fish.ply | tr -d ' \n' | grep -o '"bounds":.*' |
    awk -F '[][,]' '{ far = 0; for (i = 1; i <= NF; i++) if ($i + 0 > 3 || $i + 0 < -3) far = 1; print far ? "something flies off" : "all is near the fish" }'
