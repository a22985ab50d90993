# Constraints that hold in the assignment, and ones that cannot, named.
cp "$fixtures/vase.obj" "$fixtures/vase.tiles.json" "$fixtures/vase.slots" .
constraints() {
    printf '{"format": "meso-constraints", "version": 1, %s}\n' "$1" >"$2"
}
constraints '"pins": [{"slot": 200, "tile": "double"}], "quotas": [{"tile": "reed turn", "least": 20, "most": 20}],
    "weights": {"reed loops": 5}' sound.json
meso-solve -q --constraints sound.json --report sound.report vase.tiles.json vase.obj -o sound.slots
meso-info sound.slots | grep -o '"reed turn": [0-9]*'

constraints '"pins": [{"name": "first", "slot": 0, "tile": "double"}]' alone.json
meso-solve --constraints alone.json vase.tiles.json vase.obj -o no.slots || echo "alone: $?"
constraints '"pins": [{"slot": 200, "tile": "double"}, {"name": "beside", "slot": 201, "tile": "ribbon"}],
    "quotas": [{"tile": "double", "most": 30}]' together.json
meso-solve --constraints together.json vase.tiles.json vase.obj -o no.slots || echo "together: $?"
constraints '"quotas": [{"tile": "foot", "most": 15}]' quota.json
meso-solve --constraints quota.json vase.tiles.json vase.obj -o no.slots || echo "quota: $?"
constraints '"pins": [{"slot": 4000, "tile": "double"}]' beyond.json
meso-solve --constraints beyond.json vase.tiles.json vase.obj -o no.slots || echo "beyond: $?"
meso-solve --strands loops vase.tiles.json vase.obj -o no.slots || echo "rule: $?"

# What can be kept is kept, and the same bytes come of the same command.
meso-solve --seed 9 --keep vase.slots vase.tiles.json vase.obj -o kept.slots
for slots in vase kept; do meso-info $slots.slots | grep -A1 '"tiles": {' >$slots.txt; done
cmp vase.txt kept.txt
constraints '"pins": [{"slot": 200, "tile": "double"}]' patch.json
for engine in auto exact; do
    meso-solve --engine $engine --constraints patch.json --keep vase.slots vase.tiles.json vase.obj -o patched.slots
done
meso-solve -q --constraints sound.json --keep vase.slots vase.tiles.json vase.obj -o a.slots
cp a.slots b.slots
meso-solve -q --constraints sound.json --keep vase.slots vase.tiles.json vase.obj -o a.slots
cmp a.slots b.slots
test ! -e no.slots
