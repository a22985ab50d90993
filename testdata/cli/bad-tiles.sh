# Broken tile sets: one line that says where, status 4, no output.
try() {
    meso-solve "$1" "$fixtures/vase.obj" -o x.slots
    echo "status $?" >&2
}
tiles() {
    printf '{"format": "meso-tiles", "version": %s,\n "interfaces": [{"name": "a", "sections": []}],\n "tiles": [%s]}\n' "$1" "$2"
}
tiles 1 '{"name": "t", "sides": ["a", "b", "a", "a"]}' >unknown-interface.json
tiles 1 '{"name": "t", "sides": ["a", "a", "a"]}' >three-sides.json
tiles 1 '{"name": "t", "sides": ["a", "a", "a", "a"], "sweeps": [{"from": "0/1", "to": "2/1"}]}' >unknown-section.json
tiles 1 '' >no-tiles.json
tiles 2 '{"name": "t", "sides": ["a", "a", "a", "a"]}' >newer.json
tiles '"one"' '{"name": "t", "sides": ["a", "a", "a", "a"]}' >version.json
tiles 1 '{"name": "t", "sides": ["a", "a", "a", "a"]}, {"name": "t", "sides": ["a", "a", "a", "a"]}' >twins.json
tiles 1 '{"name": "t", "sides": ["a", "a", "a", "a"]' >broken.json
printf '{"format": "other", "version": 1}\n' >other.json
printf '{"a": 1, "a": 2}\n' >duplicate.json
printf '[1, 2\n' >cut.json
printf 'tiles: none\n' >prose.json
: >empty.json
mkdir folder.json
for tiles in unknown-interface.json three-sides.json unknown-section.json no-tiles.json newer.json version.json \
    twins.json broken.json other.json duplicate.json cut.json prose.json empty.json folder.json missing.json; do
    try $tiles
done
ls -A | grep -v '\.json$'
true
