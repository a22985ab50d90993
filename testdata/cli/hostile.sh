# Threads and memory that the system refuses, two products of one name.
cp "$fixtures"/vase.* .

# Fewer threads give the same bytes. A sanitizer's own memory does not fit under the limit.
meso-map -q --divisions 24 vase.meso -o x.ply
mv x.ply all.ply
(
    ulimit -v 400000
    if meso-map --version >/dev/null 2>&1; then
        meso-map -q --threads 1024 --divisions 24 vase.meso -o x.ply
        cmp all.ply x.ply
    fi
)

refuse() {
    status=0
    "$@" 2>err || status=$?
    echo "$status $(head -n 1 err)"
}
refuse meso-map --json=same.meso vase.meso -o same.meso
refuse meso-render --png same.exr vase.meso -o same.exr
[ ! -e same.meso ] && [ ! -e same.exr ] || echo "something was written"

# A crash leaves nothing half-written.
mkdir out
(
    ulimit -c 0
    # Background processes of a shell ignore SIGQUIT; env gives it back.
    env --default-signal=QUIT meso-map -q --divisions 400 --section-step 0.005 vase.meso -o out/x.ply &
    process=$!
    tries=0
    until [ -n "$(find out -size +100k)" ] || [ $tries -gt 600 ]; do
        sleep 0.05
        tries=$((tries + 1))
    done
    kill -s QUIT $process
    wait $process 2>/dev/null || true
)
ls -A out
