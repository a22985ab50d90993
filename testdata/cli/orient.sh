# Orientation: a surface whose faces start anywhere is as good as the one that it was made from.
drawing='"sections": [{"name": "s", "albedo": [1, 0, 0], "roughness": 1, "metallic": 0,
                   "shape": {"disc": {"center": [0.3, 0.4], "size": [0.2, 0.1], "angle": 0}}}]'
cat >stripes.json <<END
{"format": "meso-tiles", "version": 1,
 "interfaces": [{"name": "a", $drawing}, {"name": "b", $drawing}, {"name": "c", $drawing}],
 "tiles": [{"name": "one", "sides": ["a", "b", "a'", "b'"]}, {"name": "two", "sides": ["a", "c", "a'", "b'"]},
           {"name": "three", "sides": ["a", "b", "a'", "c'"]}, {"name": "four", "sides": ["a", "c", "a'", "c'"]}]}
END
# A closed band of 12 by 5 with texture coordinates along it, then with the corner lists turned,
# the first one not.
awk 'BEGIN {
    for (y = 0; y <= 5; y++) for (x = 0; x < 12; x++) printf "v %.4f %.4f %d\n", cos(x * 0.5235988), sin(x * 0.5235988), y
    for (y = 0; y <= 5; y++) for (x = 0; x <= 12; x++) printf "vt %.4f %.4f\n", x / 12, y / 5
    for (y = 0; y < 5; y++) for (x = 0; x < 12; x++) {
        i = (x + 1) % 12
        printf "f %d/%d %d/%d %d/%d %d/%d\n", y * 12 + i + 1, y * 13 + x + 2, y * 12 + i + 13, y * 13 + x + 15,
            y * 12 + x + 13, y * 13 + x + 14, y * 12 + x + 1, y * 13 + x + 1 } }' >band.obj
awk '$1 == "f" { n++; q = n == 1 ? 0 : n * 7 % 5 % 4
                 printf "f"; for (i = 0; i < 4; i++) printf " %s", $(2 + (i + q) % 4); print ""; next } { print }' band.obj >turned.obj
cmp -s band.obj turned.obj && echo "not turned"

for how in file comb u,v; do
    meso-solve --orient $how stripes.json turned.obj -o $how.slots || echo "$how: status $?"
done
meso-solve -q stripes.json band.obj -o band.slots
cmp comb.slots u,v.slots >/dev/null || meso-info comb.slots | grep -e orientation -e '"slots"'
meso-map -q stripes.json band.obj band.slots -o - --to obj | grep -v '^#' >band.mesh
for how in comb u,v; do
    meso-map -q stripes.json turned.obj $how.slots -o $how.meso
    meso-map -q $how.meso -o - --to obj | grep -v '^#' | cmp - band.mesh && echo "$how: the same mesh"
done
meso-solve -q --orient comb --json stripes.json turned.obj -o comb.slots | grep -A 4 '"orientation"'

# Not the file's order, so that the assignment fits nothing else; and words that are no orientation.
meso-map -q stripes.json band.obj comb.slots -o x.meso && echo "mapped without its surface"
meso-solve --orient up stripes.json band.obj -o x.slots || echo "status $?"
meso-solve --orient field=flow stripes.json band.obj -o x.slots || echo "status $?"
sed 's/^vt .*/vt 0 0/' band.obj >flat.obj
meso-solve --orient u,v stripes.json flat.obj -o x.slots || echo "status $?"
ls x.* 2>/dev/null
true

# An assignment to keep is seen from the direction of now.
sed 's/"rotation": false/"rotation": true/' "$fixtures/vase.tiles.json" >vase.tiles.json
cp "$fixtures/vase.obj" .
awk '$1 == "f" { q = NR * 7 % 5 % 4; printf "f"; for (i = 0; i < 4; i++) printf " %s", $(2 + (i + q) % 4); print ""; next }
     { print }' vase.obj >scrambled.obj
meso-solve -q --seed 3 vase.tiles.json scrambled.obj -o old.slots
meso-solve --seed 4 --orient comb --keep old.slots vase.tiles.json scrambled.obj -o new.slots
cmp old.slots new.slots >/dev/null || echo "other slots"
[ "$(meso-info old.slots | grep '"tiles": {')" = "$(meso-info new.slots | grep '"tiles": {')" ] && echo "the same tiles"
