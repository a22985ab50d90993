# A tile that is missing is found, and solves the vase.
cp "$fixtures/gap.tiles.json" gap.json
meso-solve -q --report report.json gap.json "$fixtures/vase.obj" -o gap.slots || echo "with a gap: status $?"
meso-suggest gap.json report.json -o mended.json
meso-solve -q mended.json "$fixtures/vase.obj" -o mended.slots || echo "mended: status $?"
meso-suggest --surface "$fixtures/vase.obj" --until-solved 3 gap.json -o until.json
meso-solve -q until.json "$fixtures/vase.obj" -o until.slots || echo "until solved: status $?"
meso-suggest mended.json --surface "$fixtures/vase.obj" -o more.json || echo "nothing missing: status $?"
# A report of another tile set, or of none that it names, is not of use.
meso-suggest mended.json report.json -o wrong.json || echo "another tile set: status $?"
sed 's/"open"/"open "/' gap.json >renamed.json
meso-suggest renamed.json report.json -o wrong.json || echo "an edited tile set: status $?"
meso-solve -q --provenance none --report bare.json gap.json "$fixtures/vase.obj" -o gap.slots 2>/dev/null
meso-suggest gap.json bare.json -o bare.tiles.json
ls
