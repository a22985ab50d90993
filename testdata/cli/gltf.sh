# Surfaces and pictures from glTF and Draco: our own files come back, and two triangles in a row are a quad.
cp "$fixtures"/* .
meso-mesh -q triangulate vase.obj -o vase.glb
meso-mesh -q triangulate vase.obj -o vase.drc
meso-mesh info vase.glb vase.drc >/dev/null 2>&1 || echo "one surface at a time: $?"
for file in vase.glb vase.drc; do
    meso-mesh info $file | grep '"faces"'
    meso-render -q --size 80x60 $file -o picture.png && echo "$file: drawn"
done
meso-solve -q vase.tiles.json vase.glb -o x.slots || echo "triangles: $?"
meso-mesh -q triangulate vase.obj -o pairs.ply
meso-solve -q --quads-from-triangles vase.tiles.json pairs.ply -o pairs.slots && echo "pairs: solved"
meso-map -q --quads-from-triangles vase.tiles.json pairs.ply pairs.slots -o pairs.meso && echo "pairs: mapped"
meso-map -q vase.meso -o whole.glb
meso-map -q whole.glb -o whole.ply
strings whole.ply | grep '^property' | tail -3
head -c 1000 vase.glb >cut.glb
meso-mesh info cut.glb || echo "cut: $?"
