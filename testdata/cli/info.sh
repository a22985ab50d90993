# Seed lines and constraints, several files at once, listings of slots.
cp "$fixtures/vase.tiles.json" "$fixtures/vase.obj" "$fixtures/vase.slots" .
facts() {
    meso-info "$@" | grep -v -e '"bytes"' -e '"xxh3_128"'
}
meso-solve -q --seeds 1-3,7 vase.tiles.json vase.obj -o seeds.jsonl
printf '{"format": "meso-constraints", "version": 1, "pins": [{"slot": 3, "tile": "double"}],
    "weights": {"a": 0.5, "b": 2}, "strands": {"acyclic": true}}' >rules.json
facts seeds.jsonl
facts rules.json
sed 's/"pins"/"pin"/' rules.json | meso-info - || echo "status $?"
sed 's/"seed":2/"seed":1/' seeds.jsonl | meso-info - || echo "status $?"

# One that is no good in the midst of others: they are described, and the status says so.
head -c 1000 vase.slots >cut.slots
meso-info vase.obj cut.slots rules.json none.obj >all.json || echo "status $?"
grep -e '"file"' -e '"kind"' -e '"error"' all.json
meso-info -q --json=report.json vase.obj rules.json -o two.json && grep -c xxh3_128 report.json
meso-info vase.obj >one.json
sed -e '1d' -e 's/^  //' -e 's/^},$/}/' -e '/^}$/q' two.json | cmp - one.json 2>&1
for i in $(seq 300); do echo rules.json; done | xargs meso-info --json=report.json -o many.json && grep -c '"file": ' many.json

# Listings, out and in, with and without an orientation: the same mesh, and nothing to change.
sed 's/"rotation": false/"rotation": true/' vase.tiles.json >free.tiles.json
meso-solve -q --orient comb free.tiles.json vase.obj -o turned.slots
mesh() {
    meso-map "$@" --to obj -o - | grep -v '^#' | cksum
}
for slots in vase turned; do
    meso-info --slots csv $slots.slots -o $slots.csv
    meso-info --slots json $slots.slots -o $slots.json
    { head -n 1 $slots.csv && sed 1d $slots.csv | sort -r; } >shuffled.csv
    head -n 3 $slots.csv
    head -n 8 $slots.json | sed '/tiles\|surface/d'
    meso-info --slots=csv $slots.json | cmp - $slots.csv
    meso-info --slots=csv shuffled.csv | cmp - $slots.csv
    for listing in $slots.slots $slots.csv $slots.json shuffled.csv; do mesh free.tiles.json vase.obj $listing; done | uniq | wc -l
done
facts vase.csv | head -n 5
facts vase.json | grep -A3 '"inputs"' | head -n 1
meso-solve --seed 5 --keep vase.csv vase.tiles.json vase.obj -o kept.slots
meso-info --slots csv kept.slots | cmp - vase.csv

# Listings that do not fit.
sed '$d' vase.csv >short.csv
sed 's/^7,[^,]*/7,no such tile/' vase.csv >other.csv
sed 's/^9,/8,/' vase.csv >twice.csv
for wrong in short other twice; do meso-map vase.tiles.json vase.obj $wrong.csv -o x.meso || echo "status $?"; done
meso-info --slots csv vase.obj || echo "status $?"
meso-info --slots csv vase.slots turned.slots || echo "status $?"
ls x.* 2>/dev/null
true
