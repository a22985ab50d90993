# Growth through textures: each way, by charts of its own and by the surface's; what cannot be.
cp "$fixtures"/*.grammar "$fixtures/paint.png" "$fixtures/vase.obj" .
try() { "$@"; echo "status $?"; }
count() { sed -n "s/.*\"$1\": \([0-9]*\).*/\1/p" "$2" | head -n 1; }
"$generators/make_column" >column.obj

echo "== each way"
for way in mesh texture texel metric; do
    meso-grow -q --provenance none --until 30 --march $way ivy.grammar vase.obj -o $way.ply --json=$way.json
    echo "$way: $? $(count elements $way.json) elements"
done

echo "== the same bytes for any number of threads; straight on by default"
for threads in 1 2 7; do
    meso-grow -q --threads $threads --until 30 --march metric ivy.grammar vase.obj -o - --to ply | cksum
done | uniq | wc -l
meso-grow -q --provenance none --until 30 ivy.grammar vase.obj -o plain.ply && cmp plain.ply mesh.ply

echo "== by the surface's own coordinates"
meso-grow -q --march texture --atlas uv --texels 512 painted.grammar column.obj -o painted.ply --json=painted.json
echo "painted: $? $(count elements painted.json) elements"

echo "== what cannot be"
printf 'v %s\n' "0 0 0" "1 0 0" "1 1 0" "0 1 0" >twice.obj
printf 'vt %s\n' "0 0" "1 0" "1 1" >>twice.obj
printf 'f %s\n' "1/1 2/2 3/3" "1/1 3/2 4/3" >>twice.obj
try meso-grow -q --march texture --atlas uv ivy.grammar twice.obj -o x.ply
try meso-grow -q --march texture --atlas uv ivy.grammar vase.obj -o x.ply
try meso-grow -q --atlas uv ivy.grammar vase.obj -o x.ply
try meso-grow -q --texels 512 --march mesh ivy.grammar vase.obj -o x.ply
try meso-grow -q --texels 8 --march metric ivy.grammar vase.obj -o x.ply
ls x.ply 2>/dev/null || echo "nothing is written"
