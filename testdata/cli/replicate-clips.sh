# Clips of every kind, of one plate that becomes twice as long: caches, and animations with a morph target or joints.
shown() { sed -n 's/.*"details": \([0-9]*\),.*/\1/p' "$1" | tr '\n' ' '; }
areas() { sed -n 's/.*"area": \(.*\),/\1/p' "$1" | tr '\n' ' '; echo; }
side=6
awk -v n=$side 'BEGIN {
    for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) printf "v %.9g %.9g 0\n", i / n - 0.5, j / n - 0.5
    for (j = 0; j < n; j++) for (i = 0; i < n; i++) { a = j * (n + 1) + i + 1; b = a + n + 1
        printf "f %d %d %d\nf %d %d %d\n", a, a + 1, b + 1, a, b + 1, b } }' >plate.obj
printf 'v -0.5 -0.4 0\nv 0.5 0 0\nv -0.5 0.4 0\nv -0.2 0 0.4\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' >scale.obj
echo '{"format": "meso-details", "version": 1, "kinds": {"scale": {"mesh": "scale.obj"}},
    "details": [{"poisson": {"count": 60}, "size": 0.05}]}' >scales.json
for kind in pc2 mdd; do "$generators/make_clip" $kind $side >plate.$kind; done
for kind in morph skin; do "$generators/make_clip" $kind $side >$kind.glb; done
if [ -d "$npm/node_modules/gltf-validator" ]; then
    for kind in morph skin; do NODE_PATH=$npm/node_modules node "$scripts/validate-glb.mjs" $kind.glb; done
fi

replicate() { meso-replicate -q --provenance none "$@"; }
for clip in "--mesh plate.obj plate.pc2" "--mesh plate.obj plate.mdd" "--fps 5 morph.glb" "--fps 5 skin.glb"; do
    name=${clip##* }
    replicate --report r.json ${clip% *} scales.json $name -o $name-%d.ply
    echo "$name: $(shown r.json): $(areas r.json)"
    cp r.json $name.json
done
cmp plate.pc2-6.ply plate.mdd-6.ply

# Twice as many samples; some of the frames; a clip that is played; and one with a state, cut.
replicate --fps 10 --report r.json scales.json morph.glb -o x-%d.ply && shown r.json && echo
replicate --frames 1-5x2 --mesh plate.obj --report r.json scales.json plate.mdd -o x-%d.ply && shown r.json && echo
replicate --mode play --frames 4 --mesh plate.obj scales.json plate.pc2 -o four.ply
replicate --mode play --mesh plate.obj scales.json plate.pc2 -o x-%d.ply && cmp x-4.ply four.ply
for frames in 1-3 4-6; do
    replicate --state s --frames $frames --fps 5 scales.json skin.glb -o cut-%d.ply
done
for frame in 1 4 6; do cmp cut-$frame.ply skin.glb-$frame.ply; done

# What cannot be.
try() { "$@"; echo "status $?"; }
try replicate scales.json plate.pc2 -o x-%d.ply
"$generators/make_clip" pc2 5 >other.pc2; try replicate --mesh plate.obj scales.json other.pc2 -o x-%d.ply
head -c 900 plate.mdd >short.mdd; try replicate --mesh plate.obj scales.json short.mdd -o x-%d.ply
try replicate --frames 7 --mesh plate.obj scales.json plate.mdd -o x-%d.ply
try replicate --fps 5 scales.json plate.obj -o x-%d.ply
{ head -c 1800 plate.pc2; printf '\377\377\377\177'; tail -c +1805 plate.pc2; } >nan.pc2
try replicate --mesh plate.obj scales.json nan.pc2 -o x-%d.ply
