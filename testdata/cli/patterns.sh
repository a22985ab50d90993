# Every pattern finds what it is for on its surface: none of its steps goes without a region or a place to begin.
for surface in vase teapot torus-knot mask; do
    "$generators/make_$(echo $surface | tr - _)" >$surface.obj
    meso-mesh -q subdivide=catmull-clark,1 triangulate $surface.obj -o $surface.ply
done
for pattern in "$testdata"/patterns/*.pattern.json; do
    name=$(basename "$pattern" .pattern.json) surface=vase
    [ ! -f $name.ply ] || surface=$name
    meso-decor "$pattern" $surface.ply -o out.meso 2>log || { echo "$name: status $?" && cat log; }
    grep -E 'no region is selected|nothing to measure' log
done
for arguments in '4 2' '0 3' '2'; do "$generators/make_torus_knot" $arguments; done
[ $? = 2 ]
