# Files as other systems write them: byte order marks, carriage returns, upper-case extensions.
mark() {
    printf '\357\273\277'
    cat "$1"
}
mark "$testdata/cli/quad.tiles.json" >TILES.JSON
printf 'v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3 4\r' >SURFACE.OBJ
printf '{"format": "meso-constraints", "version": 1, "quotas": []}\n' >plain.json
mark plain.json >RULES.JSON
meso-solve -q --constraints RULES.JSON TILES.JSON SURFACE.OBJ -o X.SLOTS --report report.json
mark report.json >REPORT.JSON
meso-suggest TILES.JSON REPORT.JSON -o y.json
for kind in MESO PLY OBJ GLB DRC; do
    meso-map -q TILES.JSON SURFACE.OBJ X.SLOTS -o X.$kind
    meso-info X.$kind | grep '"kind"'
done
for kind in EXR Png; do
    meso-render -q --size 8x8 X.MESO -o X.$kind
    meso-info X.$kind | grep '"kind"'
done
mark SURFACE.OBJ >marked.obj
for file in TILES.JSON REPORT.JSON SURFACE.OBJ marked.obj; do
    meso-info $file | grep '"kind"'
done
