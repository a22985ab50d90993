# Broken surfaces: one line that says where, status 4, no output.
try() {
    meso-solve "$fixtures/vase.tiles.json" "$1" -o x.slots
    echo "status $?" >&2
}
quad='v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n'
printf "${quad}f 1 2 3\nf 1 3 4\n" >triangles.obj
printf "${quad}f 1 2 3 4\nf 1 2 3 5\n" >index.obj
printf "${quad}f 1 2 3 0\n" >zero.obj
printf "${quad}f 1 2 3 99999999999999999999\n" >huge.obj
printf "${quad}v 0 0 1\nv 1 0 1\nv 0 0 2\nv 1 0 2\nf 1 2 3 4\nf 1 2 6 5\nf 2 1 7 8\n" >three.obj
printf "${quad}f 1 2 3 3\n" >twice.obj
printf "${quad}v nan 0 0\nf 1 2 3 5\n" >nan.obj
printf "${quad}v inf 0 0\nf 1 2 3 5\n" >inf.obj
printf "${quad}v 1e999 0 0\nf 1 2 3 5\n" >over.obj
printf "${quad}v 1 zero 0\nf 1 2 3 5\n" >word.obj
printf "${quad}" >faceless.obj
printf 'OFF\n4000000000 4000000000 0\n0 0 0\n' >count.off
printf 'OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n' >triangle.off
printf 'ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n' >cut.ply
printf 'not a mesh\n' >prose.ply
: >empty.obj
mkdir folder.obj
for surface in triangles.obj index.obj zero.obj huge.obj three.obj twice.obj nan.obj inf.obj over.obj word.obj \
    faceless.obj count.off triangle.off cut.ply prose.ply empty.obj folder.obj missing.obj; do
    try $surface
done
ls -A | grep -v -e '\.obj$' -e '\.off$' -e '\.ply$'
true
