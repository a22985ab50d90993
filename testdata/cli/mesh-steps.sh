# Steps of meso-mesh: wrong ones are refused before anything is read, and right ones done in their order.
cp "$fixtures/vase.obj" .
try() {
    status=0
    meso-mesh "$@" >out || status=$?
    echo "status $status" >&2
    [ ! -s out ] || echo "something was said: $*"
}
try
try vase.obj
try convert vase.obj
try wled vase.obj -o x.ply
try subdiv vase.obj -o x.ply
try vase.obj vase.obj -o x.ply
try weld=0 vase.obj -o x.ply
try weld=1e-4m vase.obj -o x.ply
try weld= vase.obj -o x.ply
try orient=up vase.obj -o x.ply
try subdivide=butterfly vase.obj -o x.ply
try subdivide=loop,0 vase.obj -o x.ply
try subdivide=17 vase.obj -o x.ply
try quads=loop vase.obj -o x.ply
try decimate vase.obj -o x.ply
try decimate=101% vase.obj -o x.ply
try decimate=1.5 vase.obj -o x.ply
try decimate=0 vase.obj -o x.ply
try orient vase.obj -o x.stl
try info vase.obj -o -
try info vase.obj -o x.ply --crease 200
try orient vase.obj -o vase.obj
try help nothing
try subdivide=loop vase.obj -o x.ply
try pair vase.obj -o x.ply
try subdivide=linear,16 vase.obj -o x.ply
try orient missing.obj -o x.ply
ls x.* 2>/dev/null

# What info knows of the vase, and what becomes of it.
value() { tr -d ' \n"' <"$1" | sed "s/.*[{,]$2:\([^,}]*\).*/\1/"; }
meso-mesh info vase.obj >vase.json
for name in vertices edges faces quads components border_loops euler genus closed; do
    echo "$name $(value vase.json $name)"
done
meso-mesh -q subdivide=2 triangulate decimate=50% vase.obj -o vase.ply --json=report.json
echo "decimated to $(meso-mesh info vase.ply | grep '"faces"')"
meso-mesh -q triangulate info subdivide=loop info vase.obj --json=infos.json
grep '"triangles"' infos.json

# Triangles become the quads that they were; a file through all formats is the same in the end, and through a pipe.
meso-mesh -q convert vase.obj -o quads.obj --provenance none
meso-mesh -q convert vase.obj -o vase.ply
meso-mesh -q convert vase.ply -o - | meso-mesh -q convert - -o again.obj --provenance none
cmp quads.obj again.obj
meso-mesh convert vase.obj -o vase.off
meso-mesh -q pair vase.off -o x.obj || echo "quads are no triangles: $?"
awk '/^f/ { print "f", $2, $3, $4; print "f", $2, $4, $5; next } { print }' quads.obj >triangles.obj
meso-mesh -q pair triangles.obj -o paired.obj --provenance none
cmp quads.obj paired.obj

# The same bytes for any number of threads; the command as it was; creases.
for threads in 1 2; do
    meso-mesh -q --threads $threads weld orient subdivide=2 decimate=3000 vase.obj -o threads-$threads.ply
done
cmp threads-1.ply threads-2.ply
head -c 400 threads-1.ply | grep -a -o '"command":"[^"]*"'
printf 'v %s\n' '0 0 0' '1 0 0' '0 1 0' '1 1 0' '0 0 1' '1 0 1' '0 1 1' '1 1 1' >cube.obj
printf 'f %s\n' '1 3 4 2' '5 6 8 7' '1 2 6 5' '3 7 8 4' '1 5 7 3' '2 4 8 6' >>cube.obj
meso-mesh -q subdivide=3 info cube.obj | grep -o '"volume": ......'
meso-mesh -q --crease 60 subdivide=3 info cube.obj | grep -o '"volume": ......'
# As scenes: what only those are written as.
meso-mesh -q triangulate "$fixtures/vase.obj" -o vase.glb
meso-mesh -q convert "$fixtures/vase.obj" -o vase.drc
meso-info vase.glb vase.drc | grep '"kind"\|"triangles"\|"faces"'
