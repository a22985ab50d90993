# A proof of the exact engine is one by other code's check, and is none once tampered with; other proofs have no file.
# The aperiodic set of Jeandel and Rao (11 Wang tiles, as right, top, left, bottom) tiles no torus.
awk -v n=5 'BEGIN {
    for (j = 0; j < n; j++)
        for (i = 0; i < n; i++) {
            p = 8 * atan2(1, 1) * i / n; q = 8 * atan2(1, 1) * j / n
            printf "v %f %f %f\n", (3 + cos(q)) * cos(p), (3 + cos(q)) * sin(p), sin(q)
        }
    for (j = 0; j < n; j++)
        for (i = 0; i < n; i++) {
            k = (i + 1) % n; l = (j + 1) % n
            print "f", n * j + k + 1, n * l + k + 1, n * l + i + 1, n * j + i + 1
        }
}' >torus.obj
tiles='2421 2220 1131 1232 3133 0131 0001 3102 0212 1214 3312'
{
    echo '{"format": "meso-tiles", "version": 1, "interfaces": ['
    printf '{"name": "h%d", "sections": []}, {"name": "v%d", "sections": []},' 0 0 1 1 2 2 3 3
    echo '{"name": "v4", "sections": []}], "tiles": ['
    echo "$tiles" | tr ' ' '\n' |
        sed "s/\(.\)\(.\)\(.\)\(.\)/{\"name\": \"&\", \"sides\": [\"h\1\", \"v\2\", \"h\3'\", \"v\4'\"]}/;\$!s/\$/,/"
    echo ']}'
} >aperiodic.json

meso-solve --engine exact --proof no aperiodic.json torus.obj -o x.slots || echo "aperiodic: status $?"
"$generators/check_drat" no.cnf no && echo "the proof holds"
ls

# Without its last clause, without all but that, with clauses that do not follow, with the first literals negated.
sed '/^0$/d' no >cut
sed -n '/^0$/p' no >bare
{ sed -n 's/^\([^d0].*\) 0$/\1/p' no | tr ' ' '\n' | sed 's/$/ 0/' | head -n 20 && cat no; } >units
sed 's/^[1-9]/-&/' no >negated
for proof in cut bare units negated; do
    "$generators/check_drat" no.cnf $proof 2>&1 | sed 's/ line [0-9]*//'
done
# Another formula, with fewer clauses.
sed 2,40d no.cnf >less.cnf
"$generators/check_drat" less.cnf no 2>/dev/null || echo "not a proof for another formula"

# What the search proves, and what nobody does, has no file.
echo '{"format": "meso-tiles", "version": 1, "interfaces": [{"name": "a", "sections": []}],
    "tiles": [{"name": "t", "sides": ["a", "a", "a", "a'"'"'"], "rotation": true}]}' >odd.json
meso-solve --proof odd odd.json torus.obj -o x.slots || echo "odd: status $?"
meso-solve --engine exact --conflicts 1 --proof early aperiodic.json torus.obj -o x.slots || echo "early: status $?"
meso-solve --proof - odd.json torus.obj -o x.slots || echo "dash: status $?"
ls
