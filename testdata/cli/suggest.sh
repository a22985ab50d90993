# A tile that is missing is found, and solves the vase.
awk 'index($0, "{\"name\": \"rim 2\"") { skip = 1 } !skip { print } /\]}/ { skip = 0 }' "$fixtures/vase.tiles.json" >gap.json
meso-solve -q --report report.json gap.json "$fixtures/vase.obj" -o gap.slots || echo "with a gap: status $?"
meso-suggest gap.json report.json -o mended.json
meso-solve -q mended.json "$fixtures/vase.obj" -o mended.slots || echo "mended: status $?"
meso-suggest -q --surface "$fixtures/vase.obj" --until-solved 3 gap.json -o - | cmp - mended.json | wc -l
