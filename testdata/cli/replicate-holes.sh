# Bumps and holes in one file for all frames: the faces of the first frame are those of the last, and holes that are not
# there yet are points of the surface.
awk 'BEGIN { n = 6
    for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) printf "v %g %g 0\n", 2 * i / n - 1, 2 * j / n - 1
    for (j = 0; j < n; j++) for (i = 0; i < n; i++) { a = j * (n + 1) + i + 1; b = a + n + 1
        printf "f %d %d %d %d\n", a, a + 1, b + 1, b } }' >plate.obj
details() {
    printf '{"format": "meso-details", "version": 1, "kinds": {%s},
        "details": [{"poisson": {"count": 20}, "size": 0.2, "kind": {%s}}]}\n' "$1" "$2"
}
details '"hole": {"hole": {}}' '"hole": 1' >holes.json
details '"hole": {"hole": {}}, "knob": {"bump": {"height": 0.3}}' '"hole": 1, "knob": 1' >mixed.json
meso-replicate -q --deform stretch --count 5 plate.obj -o long-%d.ply
replicate() { meso-replicate -q --fineness 4 "$@"; }

# Of a frame of a .usda: the area of the surface, as large as that of the mesh of the same frame.
area_of_usda() {
    awk -v frame="$2" '
        /def Mesh "Surface"/ { surface = 1 }
        surface && /faceVertexIndices/ { gsub(/.*\[|\].*/, ""); corners = split($0, corner, /, */) }
        surface && /points.timeSamples/ { points = 1 }
        points && $1 == frame ":" { gsub(/.*\[|\].*|[()]/, ""); split($0, p, /, */); points = surface = 0 }
        END { for (c = 1; c <= corners; c += 3) {
                  a = 3 * corner[c]; b = 3 * corner[c + 1]; d = 3 * corner[c + 2]
                  area += ((p[b + 1] - p[a + 1]) * (p[d + 2] - p[a + 2]) - (p[b + 2] - p[a + 2]) * (p[d + 1] - p[a + 1])) / 2 }
              print area }' "$1"
}
area_of_obj() {
    awk '/^v / { x[++n] = $2; y[n] = $3 }
         /^f / { split($2, i, "/"); split($3, j, "/"); split($4, k, "/"); a = i[1]; b = j[1]; d = k[1]
                 area += ((x[b] - x[a]) * (y[d] - y[a]) - (y[b] - y[a]) * (x[d] - x[a])) / 2 }
         END { print area }' "$1"
}
replicate --report one.json holes.json long-%d.ply -o holes.usda
replicate --report each.json holes.json long-%d.ply -o each-%d.obj
for frame in 1 3 5; do
    echo "$(area_of_usda holes.usda $frame) $(area_of_obj each-$frame.obj)" |
        awk '{ d = $1 - $2; print (d < 0.01 && d > -0.01 ? "as open" : "not as open: " $0) }'
done
grep -v command one.json >a; grep -v command each.json >b; cmp a b && grep -c '"born": [1-9]' one.json | awk '{ print ($1 > 5) }'

# Any number of threads, and with bumps, in a .glb that others take.
for threads in 1 2; do replicate --threads $threads mixed.json long-%d.ply -o mixed-$threads.glb; done
cmp mixed-1.glb mixed-2.glb
if [ -d "$npm/node_modules/gltf-validator" ]; then
    NODE_PATH=$npm/node_modules node "$scripts/validate-glb.mjs" mixed-1.glb
fi

# Holes at the border and on top of each other are left out, and counted.
printf '{"format": "meso-details", "version": 1, "kinds": {"hole": {"hole": {}}}, "details":
    [{"points": [[0, 0, 0], [0.02, 0, 0], [1, 0.3, 0]], "size": 0.2, "kind": "hole"}]}\n' >edge.json
meso-replicate --json=edge.report.json --frames 1 edge.json long-%d.ply -o edge.ply
grep -o '"holes_left_out": .' edge.report.json
