# Quilts: swatches by recipe, a plane, a closed surface, moved surfaces, threads, seeds; and what cannot be.
try() {
    "$@"
    echo "status $?"
}
number() { grep -o "\"$1\": [0-9.e-]*" "$2" | head -n 1; }

# A torus of 24 x 12 quads with texture coordinates, its tube TUBE thick.
torus() {
    awk -v tube="$1" 'BEGIN { n = 24; m = 12; pi = atan2(0, -1)
        for (j = 0; j < m; j++) for (i = 0; i < n; i++) {
            a = 2 * pi * i / n; b = 2 * pi * j / m; r = 1 + tube * cos(b)
            printf "v %.6f %.6f %.6f\nvt %.6f %.6f\n", r * cos(a), r * sin(a), tube * sin(b), i / n, j / m }
        for (j = 0; j < m; j++) for (i = 0; i < n; i++) {
            right = (i + 1) % n; up = (j + 1) % m
            a = j * n + i + 1; b = j * n + right + 1; c = up * n + right + 1; d = up * n + i + 1
            printf "f %d/%d %d/%d %d/%d %d/%d\n", a, a, b, b, c, c, d, d } }'
}
torus 0.4 >torus.obj
torus 0.35 >thin.obj
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

echo "== moved: the surface that it has is where it was; another one is not; only of the same faces"
meso-map torus.quilt -o a.ply && meso-map torus.quilt torus.obj -o b.ply
meso-map torus.quilt thin.obj -o c.ply
tail -c 4000 a.ply >a && tail -c 4000 b.ply >b && cmp a b && echo same faces
meso-info b.ply | grep -o '"face": [0-9]*' >b && meso-info c.ply | grep -o '"face": [0-9]*' | cmp b - && echo as many
tail -c 7000000 a.ply >a && tail -c 7000000 c.ply | cmp -s - a || echo elsewhere
sed '$d' torus.obj >hole.obj
meso-quilt -q --swatch nuts --scale 0.2 bare.obj -o bare.quilt
try meso-map bare.quilt hole.obj -o x.ply
sed 's|^f 1/1 2/2|f 2/2 1/1|' torus.obj >turned.obj
try meso-map bare.quilt turned.obj -o x.ply
try meso-map nuts.ply torus.obj -o x.ply
cp nuts.ply other.quilt && try meso-map other.quilt torus.obj -o x.ply
try meso-map --divisions 4 torus.quilt -o x.ply

echo "== a finer surface, or one that is cut otherwise, by texture coordinates"
# The torus of N x M quads, its texture cut open.
open_torus() {
    awk -v tube="$1" -v n="$2" -v m="$3" 'BEGIN { pi = atan2(0, -1); w = n + 1
        for (j = 0; j < m; j++) for (i = 0; i < n; i++) {
            a = 2 * pi * i / n; b = 2 * pi * j / m; r = 1 + tube * cos(b)
            printf "v %.6f %.6f %.6f\n", r * cos(a), r * sin(a), tube * sin(b) }
        for (j = 0; j <= m; j++) for (i = 0; i <= n; i++) printf "vt %.6f %.6f\n", i / n, j / m
        for (j = 0; j < m; j++) for (i = 0; i < n; i++) {
            right = (i + 1) % n; up = (j + 1) % m; t = j * w + i + 1
            printf "f %d/%d %d/%d %d/%d %d/%d\n", j * n + i + 1, t, j * n + right + 1, t + 1, up * n + right + 1, t + w + 1,
                up * n + i + 1, t + w } }'
}
open_torus 0.4 24 12 >open.obj
open_torus 0.4 61 31 >fine.obj
meso-quilt -q --swatch nuts --turns 4 --scale 0.2 open.obj -o open.quilt
body() { sed '1,/^end_header/d' "$1"; }
meso-map open.quilt -o own.ply && meso-map open.quilt fine.obj -o fine.ply && meso-map open.quilt open.obj -o again.ply
body own.ply >own && body again.ply | cmp - own && echo where it was
body fine.ply | cmp -s - own || echo elsewhere
# What is said of numbers depends on where the quilt has its first vertex.
tried() {
    "$@" 2>said
    echo "status $?"
    sed 's/[0-9][0-9.]*/N/g' said >&2
}
# Nearest and farthest vertex of a mesh from the circle in the middle of the torus.
reach() {
    awk '/^v / { r = sqrt($2 * $2 + $3 * $3) - 1; d = sqrt(r * r + $4 * $4); if (d > most) most = d; if (!least || d < least) least = d }
        END { print least, most }' "$1"
}
# Nuts are stiff, and sink in a little below their middle: as deep on the finer torus as on their own, whose flat faces lie
# up to 0.014 deeper.
meso-map open.quilt -o own-x.obj && meso-map open.quilt fine.obj -o fine-x.obj
echo "$(reach own-x.obj) $(reach fine-x.obj)" | awk '{ print ($3 >= $1 && $3 < $1 + 0.014 && $4 >= $2 && $4 < $2 + 0.014 && $4 < 0.52) }'
tried meso-map torus.quilt fine.obj -o x.ply
sed 's|/[0-9]*||g; /^vt/d' fine.obj >bare-fine.obj
tried meso-map open.quilt bare-fine.obj -o x.ply
sed '$s|/[0-9]*||g' fine.obj >partly.obj
tried meso-map open.quilt partly.obj -o x.ply
awk '/^vt/ { $2 = $2 / 3 } { print }' fine.obj >third.obj
tried meso-map open.quilt third.obj -o x.ply
awk '/^vt/ { $2 = 2 * ($2 > 0.5 ? $2 - 0.5 : $2) } { print }' fine.obj >twice.obj
tried meso-map open.quilt twice.obj -o x.ply
awk '/^f/ { print $1, $2, $5, $4, $3; next } { print }' fine.obj >inside-out.obj
tried meso-map open.quilt inside-out.obj -o x.ply

echo "== ways to lie over a surface"
for how in prisms normals charts; do
    meso-quilt -q --embed $how --swatch nuts --turns 4 --scale 0.2 open.obj -o $how.quilt --json=$how.json
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
    meso-quilt -q --threads $threads --embed charts --swatch nuts --turns 4 --scale 0.3 open.obj -o - --to ply | cksum
done | uniq | wc -l
try meso-map --embed charts nuts.ply -o x.ply
try meso-map --embed sideways open.quilt -o x.ply
try meso-quilt --embed sideways nuts.ply open.obj -o x.ply

echo "== with the surface under it"
meso-quilt -q --swatch nuts --turns 4 --scale 0.2 open.obj -o alone.obj
meso-quilt -q --swatch nuts --turns 4 --scale 0.2 --surface own open.obj -o both.obj
echo $(($(grep -c '^f ' both.obj) - $(grep -c '^f ' alone.obj)))
try meso-quilt -q --surface own nuts.ply open.obj -o x.quilt

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
head -c 3000 torus.quilt >cut.quilt
tried meso-map cut.quilt -o x.ply
tried meso-info cut.quilt
ls | grep '^x' || echo nothing left
