# What the solver may answer, by status and in the report.
quad='v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n'
printf "$quad" >quad.obj
tiles() {
    printf '{"format": "meso-tiles", "version": 1, "interfaces": [{"name": "a", "border": "%s", "sections": []}],
        "tiles": [{"name": "t", "sides": ["a", "a", "a", "a"]}]}' "$1"
}
tiles any >any.json
tiles exempt >exempt.json
meso-solve -q any.json quad.obj -o any.slots --report any.report.json || echo "any: status $?"
grep -c '"verdict": "solved"' any.report.json
meso-solve -q exempt.json quad.obj -o exempt.slots --report exempt.report.json || echo "exempt: status $?"
grep -c '"verdict": "unsolvable"' exempt.report.json
ls
