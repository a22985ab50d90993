# A tube and a wire run side by side and join at every end: each strand is a loop, and blanks are what is left.
pipes() {
    cat <<EOF
{"format": "meso-tiles", "version": 1, "defaults": {"rotation": true, "flip_x": true, "flip_y": true},
 "interfaces": [
  {"name": "pipe", "border": "exempt", "sections": [
   {"name": "tube", "shape": {"disc": {"center": [0.5, 0.5], "size": [0.3, 0.3]}}},
   {"name": "wire", "shape": {"disc": {"center": [0.2, 0.8], "size": [0.1, 0.1]}}}]},
  {"name": "wall"}],
 "tiles": [
  {"name": "straight", "sides": ["pipe", "wall", "pipe'", "wall'"],
   "sweeps": [{"from": "0/tube", "to": "2/tube"}, {"from": "0/wire", "to": "2/wire"}]},
  {"name": "elbow", "sides": ["pipe", "pipe'", "wall", "wall"],
   "sweeps": [{"from": "0/tube", "to": "1/tube"}, {"from": "0/wire", "to": "1/wire"}]},
  {"name": "end", "sides": ["pipe", "wall", "wall", "wall"], "sweeps": [{"from": "0/wire", "to": "0/tube"}]}$1]}
EOF
}
grid() {
    awk -v n="$1" 'BEGIN {
        for (y = 0; y <= n; y++) for (x = 0; x <= n; x++) print "v", x, y, 0
        for (y = 0; y < n; y++) for (x = 0; x < n; x++) {
            a = y * (n + 1) + x + 1
            print "f", a, a + 1, a + n + 2, a + n + 1
        }
    }'
}
pipes ', {"name": "blank", "sides": ["wall'\''", "wall", "wall", "wall'\''"]}' >pipes.json
pipes '' >no-blank.json
grid 5 >small.obj
grid 30 >large.obj

for surface in small large; do
    for rule in no-loops acyclic; do
        for engine in auto wfc exact; do
            meso-solve -q --strands $rule --engine $engine pipes.json $surface.obj -o x.slots || echo "$surface, $rule: $?"
            meso-info x.slots | grep -o '"blank": [0-9]*'
        done
    done
done
for engine in auto wfc exact; do
    meso-solve -q --strands connected,max-length=2 --engine $engine pipes.json small.obj -o x.slots || echo "short: $?"
    meso-info x.slots | grep -c '"blank": 2[35]'
done

# Without the blank there is nothing left.
meso-solve --strands no-loops no-blank.json small.obj -o no.slots || echo "no blank: $?"
meso-solve --quiet no-blank.json large.obj -o x.slots || echo "without the rule: $?"
