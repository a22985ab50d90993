# SIGTERM and SIGINT while a tool writes: nothing stays, and it dies of the signal.
mkdir out
killed() {
    for signal in TERM INT; do
        # Background processes of a shell ignore SIGINT; env gives it back.
        env --default-signal=INT "$@" &
        process=$!
        tries=0
        until [ -n "$(find out -size +100k)" ] || [ $tries -gt 600 ]; do
            sleep 0.05
            tries=$((tries + 1))
        done
        kill -s $signal $process
        status=0
        wait $process 2>/dev/null || status=$?
        echo "$signal: status $status"
        ls -A out
    done
}
killed meso-map -q --divisions 400 --section-step 0.005 "$fixtures/vase.meso" -o out/x.ply
killed meso-quilt -q --swatch rings --plane 20x20 -o out/x.obj

# Threads that create and rename a file for every seed: told to die at any moment, they leave none half made.
mkdir each
for wait in 00 01 02 03 05 08 11 15 19 23; do
    meso-solve -q --threads 4 --seeds 1-400 --each each/%d.slots "$fixtures/vase.tiles.json" "$fixtures/vase.obj" \
        -o each/lines.jsonl &
    process=$!
    tries=0
    until [ -e each/1.slots ] || [ $tries -gt 600 ]; do
        sleep 0.01
        tries=$((tries + 1))
    done
    sleep 0.$wait
    kill -s TERM $process 2>/dev/null || true
    wait $process 2>/dev/null || true
    find each -name '.*' -type f
    rm -f each/* each/.meso*
done
