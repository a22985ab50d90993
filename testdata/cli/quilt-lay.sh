# Ways for quilts to lie over a surface, and with it.
try() {
    "$@"
    echo "status $?"
}
number() { grep -o "\"$1\": [0-9.e-]*" "$2" | head -n 1; }
# torus TUBE N M [cut]
torus() { awk -v tube="$1" -v n="$2" -v m="$3" -v cut=$(($# > 3)) -f "$testdata/cli/torus.awk"; }
body() { sed '1,/^end_header/d' "$1"; }
torus 0.4 24 12 cut >open.obj
meso-quilt -q --swatch nuts --columns 3 --rows 3 -o nuts.ply
meso-quilt -q --swatch nuts --turns 4 --scale 0.4 open.obj -o open.quilt
meso-map open.quilt -o own.ply
body own.ply >own

echo "== ways to lie over a surface"
for how in prisms normals charts; do
    meso-quilt -q --embed $how --swatch nuts --turns 4 --scale 0.4 open.obj -o $how.quilt --json=$how.json
    meso-map $how.quilt -o $how.ply
    number inverted_tetrahedra $how.json
done
grep -c '"charts"\|"elements_over_seams"' charts.json
for how in prisms normals charts; do body $how.ply >$how; done
cmp -s prisms charts || echo not the same
cmp prisms own
for how in normals charts; do
    meso-map --embed $how prisms.quilt -o x-$how.ply && body x-$how.ply | cmp - $how && rm x-$how.ply
done
for threads in 1 2 7; do
    meso-quilt -q --threads $threads --embed charts --swatch nuts --turns 4 --scale 0.5 open.obj -o - --to ply | cksum
done | uniq | wc -l
try meso-map --embed charts nuts.ply -o x.ply
try meso-map --embed sideways open.quilt -o x.ply
try meso-quilt --embed sideways nuts.ply open.obj -o x.ply

echo "== with the surface under it"
meso-quilt -q --swatch nuts --turns 4 --scale 0.4 open.obj -o alone.obj
meso-quilt -q --swatch nuts --turns 4 --scale 0.4 --surface own open.obj -o both.obj
echo $(($(grep -c '^f ' both.obj) - $(grep -c '^f ' alone.obj)))
try meso-quilt -q --surface own nuts.ply open.obj -o x.quilt
ls | grep '^x' || echo nothing left
