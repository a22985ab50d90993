# SIGTERM and SIGINT while a tool writes: nothing stays, and it dies of the signal.
mkdir out
for signal in TERM INT; do
    # Background processes of a shell ignore SIGINT; env gives it back.
    env --default-signal=INT meso-map -q --divisions 400 --section-step 0.005 "$fixtures/vase.meso" -o out/x.ply &
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
