# Quilts that are moved: to surfaces of the same faces, and to others by texture coordinates.
try() {
    "$@"
    echo "status $?"
}
# torus TUBE N M [cut]
torus() { awk -v tube="$1" -v n="$2" -v m="$3" -v cut=$(($# > 3)) -f "$testdata/cli/torus.awk"; }
body() { sed '1,/^end_header/d' "$1"; }
torus 0.4 24 12 >torus.obj
torus 0.35 24 12 >thin.obj
grep -v '^vt' torus.obj | sed 's|/[0-9]*||g' >bare.obj
meso-quilt -q --swatch nuts --columns 3 --rows 3 -o nuts.ply
meso-quilt -q --swatch wire --sides 4 --guide u --scale 0.4 torus.obj -o torus.quilt

echo "== moved: the surface that it has is where it was; another one is not; only of the same faces"
meso-map torus.quilt -o a.ply && meso-map torus.quilt torus.obj -o b.ply
meso-map torus.quilt thin.obj -o c.ply
tail -c 4000 a.ply >a && tail -c 4000 b.ply >b && cmp a b && echo same faces
meso-info b.ply | grep -o '"face": [0-9]*' >b && meso-info c.ply | grep -o '"face": [0-9]*' | cmp b - && echo as many
tail -c 7000000 a.ply >a && tail -c 7000000 c.ply | cmp -s - a || echo elsewhere
sed '$d' torus.obj >hole.obj
meso-quilt -q --swatch nuts --scale 0.4 bare.obj -o bare.quilt
try meso-map bare.quilt hole.obj -o x.ply
sed 's|^f 1/1 2/2|f 2/2 1/1|' torus.obj >turned.obj
try meso-map bare.quilt turned.obj -o x.ply
try meso-map nuts.ply torus.obj -o x.ply
cp nuts.ply other.quilt && try meso-map other.quilt torus.obj -o x.ply
try meso-map --divisions 4 torus.quilt -o x.ply

echo "== a finer surface, or one that is cut otherwise, by texture coordinates"
torus 0.4 24 12 cut >open.obj
torus 0.4 61 31 cut >fine.obj
meso-quilt -q --swatch nuts --turns 4 --scale 0.2 open.obj -o open.quilt
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
ls | grep '^x' || echo nothing left
