# Patterns on surfaces: the tree, the lines, steps one by one, seeds, threads; and what cannot be.
pattern() { printf '{"format": "meso-pattern", "version": 1, "steps": [%s]}\n' "$1"; }
leaves() { grep -c '"triangles"' "$1"; }
cp "$fixtures/vase.obj" . && meso-mesh -q triangulate vase.obj -o vase.ply

echo "== a rim, a belly, dots on it"
pattern '{"contour": {"dist": "outer", "at": [0.2, 0.7]}, "names": "zone"},
         {"contour": {"dist": {"poisson": {"count": 5}}, "at": 0.06, "unit": "size"}, "on": "zone.1"}' >dots.json
meso-decor dots.json vase.ply -o dots.meso --tree dots.tree.json --lines dots.svg
leaves dots.tree.json
grep '"path"' dots.tree.json
grep -c '<g id="operation' dots.svg

meso-info dots.json dots.tree.json | grep -v '"xxh3_128"\|"bytes"\|"version"'

echo "== polygons are cut into triangles first; steps one by one"
meso-decor --until 1 dots.json vase.obj -o one.ply --tree one.json --lines one.obj
leaves one.json
grep -c '^g operation' one.obj

echo "== the same bytes for any number of threads, and from one run to the next"
cp "$fixtures/macros-square.pattern.json" .
for threads in 1 2 7; do
    meso-decor --threads $threads macros-square.pattern.json vase.ply -o - --to meso | cksum
done | uniq | wc -l

echo "== seeds: each what it is alone"
pattern '{"voronoi": {"poisson": 6}}, {"paint": {"by": "random", "materials": ["a", "b"]}}' |
    sed 's/"steps"/"materials": {"a": "#f00", "b": "#00f"}, "steps"/' >cells.json
meso-decor --seeds 1-3,7 cells.json vase.ply -o cells-%d.meso
ls cells-*.meso
meso-decor --seed 7 cells.json vase.ply -o alone.meso
cmp cells-7.meso alone.meso && cmp -s cells-1.meso cells-2.meso
echo $?
meso-decor --seeds 1-3 cells.json vase.ply -o cells.meso
echo $?
meso-decor --seeds 1-3 --seed 2 cells.json vase.ply -o cells-%d.meso
echo $?
meso-decor --seeds 1-3x2 cells.json vase.ply -o cells-%d.meso
echo $?

echo "== a single triangle, a one-sided band, two pieces of which one has the seed"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >one-face.obj
pattern '{"contour": {"dist": "borders", "count": 3}}, {"stream": {"dist": "borders", "lines": 4}}' >plain.json
meso-decor plain.json one-face.obj -o one-face.ply
awk 'BEGIN { n = 24; pi = atan2(0, -1)
    for (i = 0; i < n; i++) for (s = -1; s <= 1; s++) {
        a = 2 * pi * i / n; r = 1 + 0.3 * s * cos(a / 2)
        print "v", r * cos(a), r * sin(a), 0.3 * s * sin(a / 2) }
    for (i = 0; i + 1 < n; i++) for (k = 1; k < 3; k++) print "f", 3 * i + k, 3 * i + k + 3, 3 * i + k + 4, 3 * i + k + 1
    for (k = 1; k < 3; k++) print "f", 3 * n - 3 + k, 4 - k, 3 - k, 3 * n - 2 + k }' >band.obj
meso-decor plain.json band.obj -o band.ply --tree band.json
leaves band.json
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 1 2 3\nf 4 5 6\n' >two.obj
pattern '{"contour": {"dist": {"point": [0, 0, 0]}, "at": 0.5, "unit": "scene"}}' >corner.json
meso-decor corner.json two.obj -o two.ply --tree two.json
leaves two.json

echo "== dots that keep their distance are fewer"
pattern '{"macro": "polka-dots", "count": 30}' >near.json
pattern '{"macro": "polka-dots", "count": 30, "spacing": 0.3}' >far.json
meso-decor near.json vase.ply -o near.ply --tree near.tree.json && meso-decor far.json vase.ply -o far.ply --tree far.tree.json
grep -c '"tag": "dot"' near.tree.json far.tree.json

echo "== a narrow strip has dots where the pattern lets them near its border"
awk 'BEGIN { for (y = 0; y < 9; y++) for (x = 0; x <= 80; x++) print "v", x / 8, y / 8, 0
    for (y = 0; y < 8; y++) for (x = 0; x < 80; x++) { a = 81 * y + x + 1; print "f", a, a + 1, a + 82, a + 81 } }' >strip.obj
for border in 1 0.8 0.2 0; do
    pattern '{"macro": "polka-dots", "count": 99, "size": 0.07, "spacing": 0.17, "border": '$border'}' >strip.json
    meso-decor strip.json strip.obj -o strip.ply --tree strip.tree.json
    echo "$border: $(grep -c '"tag": "dot"' strip.tree.json)"
done

echo "== nothing to do is said"
pattern '{"contour": {"dist": "outer", "at": 0.5}, "on": "nowhere"}, {"stream": {"blend": ["inner", "outer"], "lines": 4}}' >idle.json
meso-decor idle.json vase.ply -o idle.ply
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' >four.obj
pattern '{"displace": 0.1}, {"contour": {"dist": {"point": [0, 0, 0]}, "at": 0.5}}' >closed.json
meso-decor closed.json four.obj -o four.ply

echo "== all files of a run appear, or none: a folder that is not there, a full disk"
mkdir whole
meso-decor dots.json vase.ply -o whole/a.ply --tree none/a.json
echo $?
meso-decor dots.json vase.ply -o whole/a.ply --tree whole/a.json --lines none/a.svg
echo $?
meso-decor dots.json vase.ply -o whole/a.ply --tree /dev/full
echo $?
ln -s /dev/full full.svg
meso-decor dots.json vase.ply -o whole/a.ply --tree whole/a.json --lines full.svg
echo $?
meso-decor --to ply dots.json vase.ply -o /dev/full --tree whole/a.json --lines whole/a.svg
echo $?
ls -A whole

echo "== what cannot be"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n' >crowded.obj
meso-decor plain.json crowded.obj -o crowded.ply
echo $?
pattern '{"contuor": {"dist": "outer"}}' >wrong.json
meso-decor wrong.json vase.ply -o wrong.ply
echo $?
printf '{"format": "meso-pattern", "version": 1, "macros": {"m": {"steps": [{"macro": "m"}]}}, "steps": [{"macro": "m"}]}' >loop.json
meso-decor loop.json vase.ply -o loop.ply
echo $?
pattern '{"contour": {"dist": "outer", "every": 1e-7, "unit": "scene"}}' >fine.json
meso-decor fine.json vase.ply -o fine.ply
echo $?
pattern '{"voronoi": [{"face": 99999999}, {"point": [0, 0, 0]}]}' >face.json
meso-decor face.json vase.ply -o face.ply
echo $?
pattern '{"displace": 1e30}' >high.json
meso-decor high.json vase.ply -o high.ply
echo $?
pattern '{"contour": {"noise": {"of": "field", "gain": 3e38}}}' >loud.json
meso-decor loud.json vase.ply -o high.ply
echo $?
meso-decor plain.json vase.ply -o lines.ply --lines lines.dxf
echo $?
printf 'v 0 0 0\nv 1e15 0 0\nv 0 1e15 0\nf 1 2 3\n' >far.obj
meso-decor corner.json far.obj -o far.ply --tree far.json
grep area far.json
ls | grep -E 'crowded.ply|high.ply|lines.ply|lines.dxf|wrong.ply|loop.ply|fine.ply|face.ply'
