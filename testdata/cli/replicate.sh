# Details over sequences: modes, states, plans, farms, threads; test sequences; and what cannot be.
try() { "$@"; echo "status $?"; }
count() { grep -c "$1" "$2"; }
shown() { sed -n 's/.*"details": \([0-9]*\),.*/\1/p' "$1" | tr '\n' ' '; echo; }

# A plate of 8 x 8 squares with texture coordinates, and a scale.
awk 'BEGIN { n = 8
    for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) printf "v %g %g 0\nvt %g %g\n", 2 * i / n - 1, 2 * j / n - 1, i / n, j / n
    for (j = 0; j < n; j++) for (i = 0; i < n; i++) { a = j * (n + 1) + i + 1; b = a + n + 1
        printf "f %d/%d %d/%d %d/%d %d/%d\n", a, a, a + 1, a + 1, b + 1, b + 1, b, b } }' >plate.obj
printf 'v -0.5 -0.4 0\nv 0.5 0 0\nv -0.5 0.4 0\nv -0.2 0 0.4\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' >scale.obj
details() {
    printf '{"format": "meso-details", "version": 1, "kinds": {%s}, "details": [%s]}\n' "$1" "$2"
}
details '"scale": {"mesh": "scale.obj"}' '{"poisson": {"count": 60}, "size": [0.1, 0.2], "heading": [1, 0, 0]}' >scales.json
details '"scale": {"mesh": "scale.obj"}, "hole": {"hole": {}}, "knob": {"bump": {"height": 0.3}}' \
    '{"poisson": 0.4, "size": 0.15, "kind": {"scale": 1, "hole": 1, "knob": 1}}' >mixed.json
cp "$testdata/details/breathing.deform.json" .
replicate() { meso-replicate -q "$@"; }

echo "== test sequences"
replicate --deform stretch --count 6 plate.obj -o long-%02d.ply
replicate --deform bend --count 4 plate.obj -o bent-%02d.ply
replicate --deform scale --count 4 plate.obj -o large-%02d.ply
replicate --deform breathing.deform.json --count 3 plate.obj -o breath-%d.obj
replicate --deform twist --amount 90 --count 4 --frames 2,4 plate.obj -o turned-%d.obj
ls long-*.ply breath-*.obj turned-*.obj | tr '\n' ' '; echo
replicate --deform stretch --count 6 --frames 4 plate.obj -o again-%02d.ply && cmp again-04.ply long-04.ply

echo "== density stays: stretched to twice, by all modes; enlarged by two; bent without stretch"
for mode in plan play paper; do
    replicate --mode $mode --report $mode.json scales.json long-%02d.ply -o $mode-%02d.ply
    echo "$mode: $(shown $mode.json)"
done
replicate --report large.json scales.json large-%02d.ply -o x-%02d.ply && shown large.json
replicate --report bent.json scales.json bent-%02d.ply -o x-%02d.ply && shown bent.json && count '"born": [1-9]' bent.json
rm x-*

echo "== cut at every frame and gone on with: the same bytes"
replicate --state whole.state scales.json long-%02d.ply -o out-%02d.meso && mkdir whole && mv out-* whole
for frame in 1 2 3 4 5 6; do
    replicate --state cut.state --frames $frame scales.json long-%02d.ply -o out-%02d.meso
done
for frame in 1 2 3 4 5 6; do cmp out-0$frame.meso whole/out-0$frame.meso; done
cmp whole.state cut.state && meso-info cut.state | grep '"kind"\|"last_frame"\|"command": "meso-replicate --f'
replicate --state late.state --frames 1-3 scales.json long-%02d.ply -o out-%02d.meso
cp late.state other.state
replicate --state late.state scales.json long-%02d.ply -o out-%02d.meso && cmp late.state whole.state
replicate --state other.state scales.json long-%02d.ply -o out-%02d.meso && cmp other.state whole.state
cmp out-06.meso whole/out-06.meso
meso-replicate --state other.state scales.json long-%02d.ply -o out-%02d.meso

echo "== there and back, cut on the way there"
replicate --state turn.state --frames 1-6,5-1 scales.json long-%02d.ply -o back-%02d.meso
replicate --state half.state --frames 1-3 scales.json long-%02d.ply -o half-%02d.meso
replicate --state half.state --frames 1-6,5-1 scales.json long-%02d.ply -o half-%02d.meso && cmp half.state turn.state

echo "== scattered by a density that is low, or nowhere"
thin() {
    awk -v d=$1 'NR == 1 { print "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y"
        print "property float z\nproperty float dense\nelement face 1\nproperty list uchar int vertex_indices\nend_header"
        print "0 0 0", d; print "1 0 0", d; print "1 1 0", d; print "0 1 0", d; print "4 0 1 2 3" }' scale.obj
}
details '"scale": {"mesh": "scale.obj"}' '{"scatter": 60, "density": {"attribute": "dense"}}' >thin.json
details '"scale": {"mesh": "scale.obj"}' '{"scatter": 900000, "density": {"attribute": "dense"}}' >none.json
thin 0.0001 >thin-1.ply; thin 0 >none-1.ply
meso-replicate thin.json thin-%d.ply -o x-%d.ply
try replicate none.json none-%d.ply -o x-%d.ply
rm x-*

echo "== killed: nothing half done, and the same in the end"
rm -f out-* k.state
meso-replicate -q --state k.state mixed.json long-%02d.ply -o out-%02d.ply &
sleep 0.05; kill $! 2>/dev/null; wait $! 2>/dev/null
replicate --state k.state mixed.json long-%02d.ply -o out-%02d.ply
replicate mixed.json long-%02d.ply -o full-%02d.ply
for frame in 1 2 3 4 5 6; do cmp out-0$frame.ply full-0$frame.ply; done
ls -A | grep '^\.' || echo nothing left

echo "== played: any frame alone, from a plan or without; there and back"
replicate --mode play --plan long.plan scales.json long-%02d.ply -o out-%02d.ply
cp out-04.ply four.ply
replicate --mode play --frames 4 scales.json long-%02d.ply -o out-%02d.ply && cmp out-04.ply four.ply
replicate --mode play --plan long.plan --frames 4 scales.json long-%02d.ply -o out-%02d.ply && cmp out-04.ply four.ply
replicate --mode play --plan long.plan --frames 6-1 --report back.json scales.json long-%02d.ply -o out-%02d.ply
cmp out-04.ply four.ply; shown back.json
meso-info long.plan | grep '"kind"\|"originals"'

echo "== two frames by two processes, from a plan that is kept, and from a state"
for frame in 4 5; do
    replicate --mode play --plan long.plan --frames $frame scales.json long-%02d.ply -o farm-%02d.ply &
done
wait; cmp farm-04.ply four.ply && replicate --mode play --plan long.plan --frames 5 scales.json long-%02d.ply -o out-%02d.ply
cmp farm-05.ply out-05.ply
replicate --state three.state --frames 1-3 scales.json long-%02d.ply -o out-%02d.meso
for frame in 4 6; do
    cp three.state farm-$frame.state
    replicate --state farm-$frame.state --frames 4-$frame scales.json long-%02d.ply -o farm-$frame-%02d.meso &
done
wait; cmp farm-4-04.meso whole/out-04.meso; cmp farm-6-06.meso whole/out-06.meso

echo "== the same bytes for any number of threads"
for threads in 1 2 7; do
    replicate --threads $threads mixed.json long-%02d.ply -o out-%02d.ply && cat out-0*.ply | cksum
done | uniq | wc -l
for threads in 1 2 7; do
    replicate --threads $threads --mode play --frames 5 scales.json long-%02d.ply -o - --to ply | cksum
done | uniq | wc -l

echo "== products"
for kind in meso ply obj glb drc; do
    replicate --frames 6 --surface clay scales.json long-%02d.ply -o one.$kind && meso-info one.$kind | grep '"kind"'
done
replicate --frames 6 --instances --surface own scales.json long-%02d.ply -o inst-%d.glb
replicate --surface clay scales.json long-%02d.ply -o clip.glb
replicate --surface clay --up z --unit 0.01 scales.json long-%02d.ply -o clip.usda && grep -c PointInstancer clip.usda
grep 'upAxis\|metersPerUnit' clip.usda
replicate --instances --up z scales.json long-%02d.ply -o up-%02d.glb && grep -a -c '"rotation":\[-0.7071' up-01.glb
replicate --mode play mixed.json long-%02d.ply -o holes.glb
if [ -d "$npm/node_modules/gltf-validator" ]; then
    for file in one.glb clip.glb holes.glb; do
        NODE_PATH=$npm/node_modules node "$scripts/validate-glb.mjs" $file
    done
fi
meso-info one.meso | grep '"bodies"\|"materials"' | head -n 2

echo "== the surface at rest from a file; steps between frames"
replicate --mesh plate.obj scales.json long-%02d.ply --frames 3 -o out-%02d.ply; echo "status $?"
replicate --substeps 3 --report sub.json scales.json long-%02d.ply -o out-%02d.ply && shown sub.json

echo "== scattered, evenly and by a map; as a scene has them"
details '"scale": {"mesh": "scale.obj"}' '{"scatter": 80, "size": 0.1}' >strewn.json
replicate --frames 1 --json=strewn.report.json strewn.json long-%02d.ply -o strewn.meso
grep -o '"originals": [0-9]*' strewn.report.json
awk 'BEGIN { print "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z"
    print "property float dense\nelement face 2\nproperty list uchar int vertex_indices\nend_header"
    print "-1 -1 0 0\n1 -1 0 1\n1 1 0 1\n-1 1 0 0\n3 0 1 2\n3 0 2 3" }' >dense.ply
cp dense.ply dense-1.ply
details '"scale": {"mesh": "scale.obj"}' '{"scatter": {"count": 300}, "density": {"attribute": "dense"}, "size": 0.01}' >mapped.json
replicate --frames 1 mapped.json dense-%d.ply -o mapped.obj
awk '/^v / { n++; right += $2 > 0 } END { print (right / n > 0.7 && right / n < 0.8 ? "three of four" : right / n) }' mapped.obj
details '"scale": {"mesh": "scale.obj"}' '{"scene": {"file": "strewn.meso", "channel": "detail"}}' >taken.json
replicate --frames 1 --json=taken.report.json taken.json long-%02d.ply -o taken.meso
grep -o '"originals": [0-9]*' taken.report.json

echo "== what cannot be"
try replicate scales.json long-%02d.ply -o x.ply
try replicate scales.json long-%02d.ply -o x-%02d.xyz
try replicate scales.json long-%02d.ply -o x-%02d.usda
try replicate --state x.state scales.json long-%02d.ply -o x.glb
try replicate --instances scales.json long-%02d.ply -o x-%02d.ply
try replicate --instances --tangents scales.json long-%02d.ply -o x-%02d.glb
try replicate --state x.state --mode play scales.json long-%02d.ply -o x-%02d.ply
try replicate --plan x.plan scales.json long-%02d.ply -o x-%02d.ply
try replicate --alpha 2 scales.json long-%02d.ply -o x-%02d.ply
try replicate --mode paper mixed.json long-%02d.ply -o x.usda
try replicate scales.json -o x-%02d.ply
try replicate scales.json plate.obj -o x-%02d.ply
try replicate scales.json nowhere-%02d.ply -o x-%02d.ply
try replicate scales.json long-%02d.ply -o long-%02d.ply
try replicate --frames 5-9 scales.json long-%02d.ply -o x-%02d.ply
try replicate --surface "clay #zzz" scales.json long-%02d.ply -o x-%02d.ply
try replicate plate.obj long-%02d.ply -o x-%02d.ply
try replicate --deform knot plate.obj -o x-%02d.ply
try replicate --deform stretch plate.obj -o x.ply
try replicate --deform stretch --amount -1 plate.obj -o x-%02d.ply
try replicate --deform breathing.deform.json --amount 1 plate.obj -o x-%02d.ply
details '"scale": {"mesh": "nowhere.obj"}' '{"poisson": 0.2}' >x.json && try replicate x.json long-%02d.ply -o x-%02d.ply
details '"hole": {"hole": {}}' '{"poisson": 0.2, "size": [1, 2], "size_map": {"attribute": "thick"}}' >x.json
try replicate x.json long-%02d.ply -o x-%02d.ply
details '"hole": {"hole": {}}' '{"poisson": 1e-9}' >x.json && try replicate x.json long-%02d.ply -o x-%02d.ply

echo "== states and plans of something else"
try replicate --seed 2 --state whole.state scales.json long-%02d.ply -o x-%02d.ply
try replicate --mu 0.5 --state whole.state scales.json long-%02d.ply -o x-%02d.ply
try replicate --state whole.state mixed.json long-%02d.ply -o x-%02d.ply
try replicate --mode paper --state whole.state scales.json long-%02d.ply -o x-%02d.ply
sed 's/^v -1 -1 0/v -1.1 -1 0/' plate.obj >other.obj
try replicate --state whole.state --mesh other.obj scales.json long-%02d.ply -o x-%02d.ply
try replicate --mode play --plan whole.state scales.json long-%02d.ply -o x-%02d.ply
try replicate --mode play --plan long.plan --mesh other.obj scales.json long-%02d.ply -o x-%02d.ply
head -c 3000 whole.state >short.state && try replicate --state short.state scales.json long-%02d.ply -o x-%02d.ply

echo "== frames that are broken"
for frame in 1 2 3 4; do cp breath-1.obj bad-$frame.obj; done
rm bad-2.obj && try replicate scales.json bad-%d.obj -o x-%02d.ply
sed '$d' breath-1.obj >bad-2.obj && try replicate scales.json bad-%d.obj -o x-%02d.ply
awk '/^v / && ++n == 5 { $2 = "nan" } { print }' breath-1.obj >bad-2.obj && try replicate scales.json bad-%d.obj -o x-%02d.ply
rm -f x-*
awk '/^v / && ++n < 12 { $2 = $3 = $4 = 0 } { print }' breath-1.obj >bad-2.obj
try replicate scales.json bad-%d.obj -o out-%02d.ply
awk '/^v / { $4 = $2 > 0 ? $2 : -$2; $2 = $2 > 0 ? -$2 : $2 } { print }' breath-1.obj >bad-2.obj
try replicate mixed.json bad-%d.obj -o out-%02d.ply

echo "== a disk that is full"
try replicate --frames 1 scales.json long-%02d.ply --to ply -o /dev/full
(ulimit -f 4; try replicate --state full.state scales.json long-%02d.ply -o x-%02d.ply) 2>&1
ls | grep '^x-\|full.state' || echo nothing left
if [ -d "$npm/node_modules/ajv" ]; then
    NODE_PATH=$npm/node_modules node "$scripts/validate-json.mjs" \
        "$(dirname "$scripts")/formats/replicate/meso-replication.schema.json" plan.json play.json back.json
fi
