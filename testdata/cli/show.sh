# --show: the surface and its singular corners, assignments, their differences, failing slots, strands, ids. Numbers of
# faces by what they show come from elsewhere, too. What does not go together is refused.
cp "$fixtures/vase.obj" "$fixtures/vase.slots" "$fixtures/vase.tiles.json" "$fixtures/vase.meso" .
show() { meso-render -q --size 60x40 --samples 1 "$@" --json=said; }
# report KEY
report() { tr -d ' \n' <said | grep -o "\"$1\":{[^}]*}"; }
# A cube of four quads a side: eight corners of three.
awk 'BEGIN {
    n = 2
    for (f = 0; f < 6; f++)
        for (i = 0; i < n; i++)
            for (j = 0; j < n; j++) {
                for (k = 0; k < 4; k++) {
                    u = i + (k == 1 || k == 2); v = j + (k > 1)
                    a = f % 3; p[a] = f < 3 ? n : 0
                    p[(a + 1) % 3] = f < 3 ? u : v; p[(a + 2) % 3] = f < 3 ? v : u
                    key = p[0] " " p[1] " " p[2]
                    if (!(key in number)) { number[key] = ++count; print "v " key }
                    face = face " " number[key]
                }
                print "f" face; face = ""
            }
}' >cube.obj
show --show macro cube.obj -o cube.png
report singular_corners
show --show macro vase.obj -o macro.png
report singular_corners
show --show macro vase.meso -o model.png
report singular_corners

show --show tiles vase.obj vase.slots -o tiles.exr --aov cryptomatte
report tiles
report tiles >of_slots
exrheader tiles.exr | grep -c 'manifest.*"borders"'
show --show tiles vase.meso -o tiles.png
report tiles | cmp - of_slots
meso-solve -q --seed 2 vase.tiles.json vase.obj -o other.slots
show --show tiles vase.tiles.json vase.obj vase.slots -o tiles.png
report tiles | cmp - of_slots
show --show difference vase.tiles.json vase.obj other.slots vase.slots -o none.png
report difference >one
show --show difference vase.obj vase.slots other.slots -o none.png
report difference | cmp - one
show --show difference vase.obj vase.slots vase.slots -o none.png
report difference
show --show difference vase.obj vase.slots other.slots -o some.png
report difference | tr ',{}' '\n' | sed -n 's/.*:\([0-9]*\)$/\1/p' | awk '{n += $1} END {print n}'

echo '{"format": "meso-tiles", "version": 1, "interfaces": [{"name": "a", "sections": []}, {"name": "b", "sections": []}],
    "tiles": [{"name": "x", "sides": ["a", "b", "a", "b"]}]}' >no.tiles.json
meso-solve -q --report no.json no.tiles.json vase.obj -o no.slots || echo "status $?"
show --show failures --report no.json vase.obj -o failures.png
report failures

show --show strands --aov cryptomatte vase.meso -o strands.exr
exrheader strands.exr | grep -c 'cryptomatte/.*"crypto_strand"'
show --show id:tile vase.meso -o ids.png
show vase.meso -o plain.png
cmp -s ids.png plain.png && echo "the colours are the materials'"

refuse() {
    status=0
    show "$@" -o x.png || status=$?
    echo "status $status"
}
refuse --show nothing vase.obj
refuse --show id: vase.meso
refuse --show id:region vase.meso
refuse --show tiles vase.obj
refuse --show difference vase.obj vase.slots
refuse --show tiles cube.obj vase.slots
refuse --show tiles no.tiles.json vase.obj vase.slots
refuse --show tiles vase.obj vase.obj vase.slots
refuse --show failures vase.obj
refuse --show failures --report no.json cube.obj
refuse --show failures --report vase.tiles.json vase.obj
refuse --show macro --report no.json vase.obj
refuse --show macro --tiles vase.tiles.json
sed 's/"slots": \[/"slots": [240, /' no.json >beyond.json
refuse --show failures --report beyond.json vase.obj
ls x.png 2>/dev/null
true
