# What meso-check finds, of what kind of file ever; bounds, marks, assignments; and what is refused.
cp "$fixtures"/vase.* .
# Two tetrahedra of two strands in two slots, one through the other, of which the second has a hole.
cat >two.ply <<'END'
ply
format ascii 1.0
element vertex 8
property float x
property float y
property float z
element face 7
property list uchar int vertex_indices
property uint slot
property int strand
end_header
0 0 0
2 0 0
0 2 0
0 0 2
0.25 0.25 -1
1.25 0.25 -1
0.25 1.25 -1
0.25 0.25 1
3 0 2 1 0 7
3 0 1 3 0 7
3 0 3 2 0 7
3 1 2 3 0 7
3 4 5 7 4294967293 9
3 4 7 6 4294967293 9
3 5 6 7 4294967293 9
END
meso-check two.ply; echo "status $?"
meso-check -q --max-open 0 --max-depth 0.1 --min-thickness 2 --max-crossings 0 --max-gap 0 two.ply; echo "status $?"
meso-check -q --max-open 1 --max-floating 0 --max-crossings 1 two.ply; echo "status $?"
meso-check -q --max-open 0 two.ply -o two.json; echo "status $?"
grep -v -e xxh3 -e '"version"' two.json
meso-check two.ply -o - | grep -c '"deep"'

# A face of no area, one twice, one that comes back to a vertex, one wound the other way.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0.5 0 0\nf 1 3 2\nf 1 2 4\nf 1 3 4\nf 2 3 4\nf 3 2 1\nf 1 5 2\nf 2 2 3\n' >bad.obj
meso-check --fast bad.obj; echo "status $?"
meso-check -q --max-faults 9 bad.obj; echo "status $?"

# Marks are drawn and read as any mesh; the same bytes for any number of threads.
meso-check -q --fast --max-faults 9 --mark faults.ply bad.obj && meso-check --fast faults.ply | head -n 1 | cut -c 1-40
meso-info faults.ply | grep '"faces"'
for threads in 1 2 7; do
    meso-check -q --threads $threads --max-faults 99999 --mark m$threads.ply two.ply -o m$threads.json
    cmp m1.ply m$threads.ply
    cmp m1.json m$threads.json
done

# The same of a model and of what is written of it, which knows its strands and no hexahedra.
meso-map -q --divisions 6 --section-step 0.1 vase.meso -o small.meso
for kind in ply obj glb drc; do
    meso-map -q small.meso -o small.$kind
    meso-check --fast --max-faults 99999 small.$kind | sed 's/:.*//' >$kind.txt || echo "$kind: status $?"
done
meso-check --fast --max-faults 99999 --max-gap 0 --max-open 0 small.meso | sed 's/, over.*//; s/:.*//' >meso.txt || echo "status $?"
grep -e open -e border -e lid -e gap -e fold meso.txt
sed 1d ply.txt | grep -v -e fold -e border -e lid >ply.faults
sed 's/strands that leak/pieces that leak/' ply.faults >ply.words      # a mesh has the strands' numbers
grep -v -e sizes -e fold -e border -e lid meso.txt | diff - ply.words

# Tubes fold back on themselves in narrow bends where these are as drawn, and not where they are mitred again.
meso-map -q --bends drawn small.meso -o drawn.meso
meso-check --fast --max-faults 99999 drawn.meso | grep pinch
meso-map -q --bends mitred drawn.meso --to stl -o mitred.stl
meso-map -q small.meso --to stl -o small.stl
tail -c +81 small.stl >small.body
tail -c +81 mitred.stl | cmp - small.body

# A model in which nothing is wrong.
meso-solve -q "$testdata/cli/quad.tiles.json" vase.obj -o plain.slots
meso-map -q "$testdata/cli/quad.tiles.json" vase.obj plain.slots -o plain.meso
meso-check -q --fast --max-gap 0 --max-angle 0.01 plain.meso; echo "status $?"

# Assignments.
meso-check vase.slots; echo "status $?"
meso-check vase.slots --tiles vase.tiles.json --surface vase.obj; echo "status $?"
meso-info --slots csv vase.slots | sed 's/^200,[^,]*/200,double/' >edited.csv
meso-check edited.csv --tiles vase.tiles.json --surface vase.obj; echo "status $?"

# What is refused.
refuse() {
    meso-check "$@" >/dev/null
    echo "status $?" >&2
}
printf 'v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n' >nan.obj
: >empty.ply
sed "s/4294967293 9/4294967295 9/" two.ply >huge.ply
head -c 4000 vase.meso >cut.meso
for file in nan.obj empty.ply huge.ply cut.meso vase.tiles.json none.obj; do refuse $file; done
refuse
refuse two.ply bad.obj
refuse --fast --max-crossings 0 two.ply
refuse --tiles vase.tiles.json vase.slots
refuse --tiles vase.tiles.json --surface vase.obj two.ply
refuse --mark x.ply vase.slots
refuse --mark two.ply two.ply
refuse --mark - two.ply
refuse --max-open -1 two.ply
refuse --max-gap 0 bad.obj
refuse --max-angle 0 two.ply
refuse -o no/such.json two.ply
