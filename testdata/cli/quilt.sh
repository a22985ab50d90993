# Quilts: swatches by recipe, a plane, a closed surface, threads, seeds; and what cannot be.
try() {
    "$@"
    echo "status $?"
}
number() { grep -o "\"$1\": [0-9.e-]*" "$2" | head -n 1; }
# torus TUBE N M [cut]
torus() { awk -v tube="$1" -v n="$2" -v m="$3" -v cut=$(($# > 3)) -f "$testdata/cli/torus.awk"; }
torus 0.4 24 12 >torus.obj
grep -v '^vt' torus.obj | sed 's|/[0-9]*||g' >bare.obj

echo "== swatches"
meso-quilt --swatch nuts --columns 3 --rows 3 -o nuts.ply
meso-quilt --swatch rings --columns 3 --rows 3 --sides 4 -o rings.ply    # of few triangles, for what is said often
meso-quilt --swatch weave --columns 4 --rows 4 >weave.ply && head -n 1 weave.ply
for name in weave wire mail rings nuts apples ivy scales armour; do
    meso-quilt -q --swatch $name -o $name.obj && meso-info $name.obj | grep -c '"kind"'
done

echo "== a plane"
meso-quilt nuts.ply --plane 4x3 -o nuts.quilt --json=nuts.json
meso-info nuts.quilt | grep '"kind"\|"command"\|"surface"'
number closed_loops nuts.json
meso-quilt -q rings.ply --plane 4x3 -o rings.glb
meso-quilt --check rings.ply --plane 4x3 -o checked.quilt --json=checked.json 2>&1 | sed 1d
sed -n '/"mesh": {/,/}/p' checked.json
meso-map nuts.quilt -o again.glb && meso-info again.glb | grep '"kind"'

echo "== the same bytes for any number of threads, and from one run to the next"
for threads in 1 2 7; do
    meso-quilt -q --threads $threads --swatch weave --sides 5 --until 4 --scale 0.1 torus.obj -o - --to quilt | cksum
done | uniq | wc -l
for threads in 1 2 7; do
    meso-quilt -q --threads $threads --swatch mail --sides 4 --until 4 --scale 0.1 torus.obj -o - --to meso | cksum
done | uniq | wc -l

echo "== a closed surface, with the scale that is said"
meso-quilt -q --swatch wire --sides 4 --guide u --scale 0.2 torus.obj -o torus.quilt --json=torus.json
meso-quilt --swatch wire --sides 4 --until 1 torus.obj -o one.quilt
number open_sections torus.json
meso-render -q --size 64x48 --samples 1 torus.quilt -o torus.png && meso-info torus.png | grep '"kind"'

echo "== guides"
awk 'BEGIN { for (i = 0; i < 288; i++) print i % 2, 0, 1 - i % 2 }' >along.txt
for guide in smooth auto v none along.txt; do
    meso-quilt -q --swatch mail --sides 4 --until 3 --scale 0.1 --turns 4 --guide $guide torus.obj -o guide.meso || echo $guide
done
head -n 100 along.txt >few.txt
try meso-quilt -q --swatch nuts --guide few.txt torus.obj -o x.ply
try meso-quilt -q --swatch nuts --guide field=wind torus.obj -o x.ply
try meso-quilt -q --swatch nuts --guide missing.txt torus.obj -o x.ply
try meso-quilt -q --swatch nuts --guide u bare.obj -o x.ply

echo "== seeds: each what it is alone"
meso-quilt -q --seeds 1-2 rings.ply --plane 4x4 -o rings-%d.meso
meso-quilt -q --seed 2 rings.ply --plane 4x4 -o alone.meso
cmp rings-2.meso alone.meso && echo same
try meso-quilt -q --seeds 1-2 rings.ply --plane 3x3 -o rings.meso
try meso-quilt -q --seeds 1-2 --seed 1 nuts.ply --plane 3x3 -o nuts-%d.meso

echo "== what cannot be"
try meso-quilt nuts.ply -o x.ply
try meso-quilt nuts.ply torus.obj --plane 3x3 -o x.ply
try meso-quilt --swatch nuts --plane 3x3 torus.obj -o x.ply
try meso-quilt --swatch nuts -o x.glb
try meso-quilt --swatch bolts -o x.ply
try meso-quilt --columns 3 nuts.ply torus.obj -o x.ply
try meso-quilt nuts.ply --plane 3 -o x.ply
try meso-quilt nuts.ply --plane 0x3 -o x.ply
try meso-quilt nuts.ply --plane 3xinf -o x.ply
try meso-quilt -q rings.ply --plane 0.5x0.5 -o x.quilt
try meso-quilt nuts.ply torus.obj -o x.stp
try meso-quilt --speed 3 nuts.ply torus.obj -o x.quilt
try meso-quilt torus.quilt torus.obj -o x.ply
try meso-quilt nuts.ply nuts.quilt -o x.ply
try meso-quilt --periodic x nuts.ply nowhere.obj -o x.ply
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n' >crowded.obj
try meso-quilt nuts.ply crowded.obj -o x.ply
try meso-quilt crowded.obj torus.obj -o x.ply
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 3 4\n' >against.obj
try meso-quilt nuts.ply against.obj -o x.ply
# What is said of numbers depends on where the quilt has its first vertex.
tried() {
    "$@" 2>said
    echo "status $?"
    sed 's/[0-9][0-9.]*/N/g' said >&2
}
head -c 3000 torus.quilt >cut.quilt
tried meso-map cut.quilt -o x.ply
tried meso-info cut.quilt
ls | grep '^x' || echo nothing left
