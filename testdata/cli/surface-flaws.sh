# Surfaces other than they look: each flaw is said once, before the work, with the command that mends it.
solve() {
    meso-solve --attempts 5 "$tiles" "$@" -o x.slots
    echo "status $?" >&2
}
tiles=$testdata/cli/quad.tiles.json
quad='v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n'
printf "${quad}v 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nf 1 2 3 4\nf 5 6 7 8\n" >split.obj
printf "${quad}v 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 3 6 5\n" >reversed.obj
printf "${quad}v 2 0 0\nv 2 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\nf 2//1 3//1 6//1 5//1\n" >wound.obj
printf "${quad}v 2 0 0\nv 2 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\nf 2 5 6 3//1\n" >bare.obj
printf "${quad}v 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n" >sound.obj
printf 'v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3 4\n' >line.obj
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nf 1 2 3 4\n' >corners.obj
printf 'v 0 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nvn 0 1 0\nf 1//1 2//1 3//1 4//1\n' >along.obj
# A band of three faces whose last one is joined to the first by a half turn; then with normals of its own.
band='v 2 0 -1\nv 2 0 1\nv -1.5 1.7 -0.5\nv -0.5 0.9 0.5\nv -0.5 -0.9 -0.5\nv -1.5 -1.7 0.5\n'
printf "${band}f 1 3 4 2\nf 3 5 6 4\nf 5 2 1 6\n" >moebius.obj
printf "${band}vn 0.6 0 0.8\nf 1//1 3//1 4//1 2//1\nf 3//1 5//1 6//1 4//1\nf 5//1 2//1 1//1 6//1\n" >given.obj
for surface in sound split reversed wound bare line corners along moebius given; do
    solve $surface.obj
done

echo "strict" >&2
for surface in sound split reversed wound bare line given; do
    solve --strict $surface.obj
done

# Where tiles may show nothing on a side, corners on one point may be mapped.
echo "plain" >&2
sed 's|"interfaces": \[|&{"name": "plain", "sections": []},|; s|"tiles": \[|&{"name": "nothing", "sides": ["plain", "plain", "plain", "plain"]},|' \
    "$tiles" >plain.json
tiles=plain.json
solve corners.obj

# The other tools say the same; the report has the counts.
echo "others" >&2
tiles=$testdata/cli/quad.tiles.json
meso-solve -q --json=report.json "$tiles" split.obj -o split.slots
sed -n '/"surface": {/,/}/p' report.json
meso-map "$tiles" split.obj split.slots -o x.meso
echo "status $?" >&2
meso-map --strict "$tiles" split.obj split.slots -o y.meso
echo "status $?" >&2
meso-map --strict x.meso -o y.meso
echo "status $?" >&2
meso-suggest --strict --surface split.obj "$tiles" -o y.json
echo "status $?" >&2
meso-suggest --strict "$tiles" report.json -o y.json
echo "status $?" >&2
ls y.* 2>/dev/null
true
