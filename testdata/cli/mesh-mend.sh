# Surfaces with something wrong: what info says would mend them does, and the result solves.
torus() {   # NX NY: grid with the seam of a texture, whose vertices are there twice
    awk -v nx=$1 -v ny=$2 'BEGIN {
        pi = atan2(0, -1)
        for (j = 0; j <= ny; j++)
            for (i = 0; i <= nx; i++) {
                a = 2 * pi * (i % nx) / nx; b = 2 * pi * (j % ny) / ny; r = 3 + cos(b)
                printf "v %.6f %.6f %.6f\nvt %.6f %.6f\n", r * cos(a), r * sin(a), sin(b), i / nx, j / ny
            }
        for (j = 0; j < ny; j++)
            for (i = 0; i < nx; i++) {
                v = j * (nx + 1) + i + 1; w = v + nx + 1
                printf "f %d/%d %d/%d %d/%d %d/%d\n", v, v, v + 1, v + 1, w + 1, w + 1, w, w
            }
    }'
}
grid() {    # NX NY: a flat sheet of quads, without holes or seams
    awk -v nx=$1 -v ny=$2 'BEGIN {
        for (j = 0; j <= ny; j++) for (i = 0; i <= nx; i++) print "v", i, j, 0
        for (j = 0; j < ny; j++) for (i = 0; i < nx; i++) {
            v = j * (nx + 1) + i + 1; w = v + nx + 1
            print "f", v, v + 1, w + 1, w
        }
    }'
}
cube() {    # a box of six quads, seen from outside
    printf 'v %s\n' '0 0 0' '1 0 0' '0 1 0' '1 1 0' '0 0 1' '1 0 1' '0 1 1' '1 1 1'
    printf 'f %s\n' '1 3 4 2' '5 6 8 7' '1 2 6 5' '3 7 8 4' '1 5 7 3' '2 4 8 6'
}
backwards() { awk '/^f/ && NR % '$1' == 0 { print "f", $5, $4, $3, $2; next } { print }'; }

torus 12 8 >seam.obj
cube | awk '/^v/ { p[++n] = $0 } /^f/ { for (k = 2; k <= 5; k++) print p[$k]; m += 4; f = f "f " m - 3 " " m - 2 " " m - 1 " " m "\n" }
    END { printf f }' >soup.obj
meso-mesh -q weld seam.obj -o torus.obj
sed 's|/[0-9]*||g; /^vt/d' torus.obj | backwards 3 >flipped.obj
cube | backwards 1 >inside-out.obj
{ grid 4 4; echo f 1 2 7 6; echo f 6 7 2 1; } >double.obj
{ grid 4 4; echo f 1 2 3 4; } >flat.obj
{ grid 4 4; printf 'v 9 9 9\nv 8 8 8\n'; } >unused.obj
grid 4 4 | awk '/^f/ { print "f", $2, $3, $4; print "f", $2, $4, $5; next } { print }' >triangles.obj
{ printf 'v %s\n' '0 0 0' '2 0 0' '3 2 0' '2 4 0' '0 4 0' '-1 2 0' '5 2 0' '5 0 0'; echo f 1 2 3 4 5 6; echo f 2 8 7 3; } >polygons.obj
{ grid 4 4; printf 'v 1 1 1\nv 2 1 1\nf 7 8 27 26\n'; } >fin.obj
cube | awk '/^f/ { print $0, $5; print "f", $2, $3; print "f", $2, $4, $2; next } { print }' >twice.obj
torus 12 8 | awk '/^v / && NR % 7 == 0 { $2 += 0.00001 } { print }' >near.obj

mend() {    # FILE STEP...: the steps are those that info asks for
    file=$1
    shift
    asked=$(meso-mesh info $file | tr -d ' \n"' | sed 's/.*mend:\[\([^]]*\)\].*/\1/; s/,/ /g')
    echo "$file: $asked"
    meso-mesh "$@" $file -o mended.obj
    left=$(meso-mesh info mended.obj | tr -d ' \n"' | sed 's/.*mend:\[\([^]]*\)\].*/\1/; s/,/ /g')
    [ -z "$left" ] || echo "still: $left"
    meso-solve -q "$testdata/cli/quad.tiles.json" mended.obj -o mended.slots || echo "not solved: $?"
}
mend seam.obj weld
mend soup.obj weld
mend flipped.obj orient
mend inside-out.obj orient subdivide
mend double.obj clean
mend flat.obj clean
mend unused.obj clean
mend twice.obj clean
mend triangles.obj quads
mend triangles.obj pair
mend polygons.obj quads
mend fin.obj separate
mend near.obj weld=1e-4
{ cat fin.obj; echo f 1 7 13 13; } >both.obj
mend both.obj clean separate

# Faces that no tool takes are read for clean alone; and the texture keeps its seam where the surface has none.
meso-mesh orient twice.obj -o refused.obj || echo "status $?"
meso-mesh -q weld seam.obj -o whole.obj
grep -c '^vt' seam.obj whole.obj
