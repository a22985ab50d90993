# Nothing pops: largest changes halve with the step between frames, and pictures of a slow stretch change evenly; what does
# pop is noticed.
awk 'BEGIN { n = 6
    for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) printf "v %g %g 0\n", 2 * i / n - 1, 2 * j / n - 1
    for (j = 0; j < n; j++) for (i = 0; i < n; i++) { a = j * (n + 1) + i + 1; b = a + n + 1
        printf "f %d %d %d %d\n", a, a + 1, b + 1, b } }' >plate.obj
details() {
    printf '{"format": "meso-details", "version": 1, "kinds": {"knob": {"bump": {"height": 0.3}}, "hole": {"hole": {}}},
        "details": [{"poisson": {"count": 20}, "size": 0.16, "kind": {"knob": 1, "hole": 1}}%s]}\n' "$1"
}
details '' >knobs.json
play() { meso-replicate -q --mode play --ramp 0.3 --fineness 3 "$@"; }

# The largest move of a vertex from one of these frames to the next.
largest() {
    awk 'FNR == 1 { n = 0; file++ }
        /^v / { n++; d = ($2 - x[n])^2 + ($3 - y[n])^2 + ($4 - z[n])^2; if (file > 1 && d > most) most = d
                x[n] = $2; y[n] = $3; z[n] = $4 }
        END { print sqrt(most) }' "$@"
}
meso-replicate -q --deform stretch --amount 1.2 --count 9 plate.obj -o body-%02d.ply
play knobs.json body-%02d.ply -o fine-%02d.obj
play --frames 1-9x2 knobs.json body-%02d.ply -o coarse-%02d.obj
echo "$(largest coarse-*.obj) $(largest fine-*.obj)" |
    awk '{ print ($1 / $2 > 1.8 && $1 / $2 < 2.2 ? "halves" : "does not halve: " $0) }'

# Pictures: how much each is another than that before it, the largest and the least.
meso-replicate -q --deform stretch --amount 1.06 --count 4 plate.obj -o slow-%d.ply
draw() { meso-render -q --size 200x140 --samples 4 --eye 0,-1,6 --target 0,0,0 "$1.meso" -o "$1.png"; }
change() { oiiotool "$1" "$2" --diff | sed -n 's/.*RMS error = //p'; }
play knobs.json slow-%d.ply -o slow-%d.meso
details ', {"points": [[0.06, 0.02, 0]], "size": 0.16, "kind": "knob"}' >more.json
play --frames 4 more.json slow-%d.ply -o planted-%d.meso
for frame in slow-1 slow-2 slow-3 slow-4 planted-4; do draw $frame; done
for i in 1 2 3; do change slow-$i.png slow-$((i + 1)).png; done | sort -g | sed -n '1p;$p' | tr '\n' ' ' >evenly
awk '{ print ($2 < 1.3 * $1 ? "evenly" : "not evenly: " $0) }' evenly
echo "$(cat evenly) $(change slow-3.png planted-4.png)" | awk '{ print ($3 > 1.3 * $2 ? "noticed" : "not noticed: " $0) }'
