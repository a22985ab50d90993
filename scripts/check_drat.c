/*
 * Checks that a DRAT proof shows that a formula has no solution: silent and 0 where
 * it does, else a line to standard error and 1.
 *
 *     check_drat FORMULA.cnf PROOF
 */
#include <stdio.h>

#include "libcore/sat/drat_checker.h"

/* All of the file, with a zero behind it. */
static char *read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    char *text = NULL;
    size_t used = 0, got = 1;
    if (!file) {
        fprintf(stderr, "check_drat: cannot read '%s'\n", path);
        exit(2);
    }
    for (size_t room = 1 << 16; got; room *= 2) {
        text = realloc(text, room + 1);
        CHECK(text);
        got = fread(text + used, 1, room - used, file);
        used += got;
    }
    text[used] = 0;
    fclose(file);
    return text;
}

int main(int argc, char **argv)
{
    static DratChecker checker;
    if (argc != 3) {
        fprintf(stderr, "usage: check_drat FORMULA.cnf PROOF\n");
        return 2;
    }
    char *formula = read_file(argv[1]), *proof = read_file(argv[2]);
    drat_init(&checker);
    drat_read_formula(&checker, formula);
    bool proved = !checker.finding && drat_check(&checker, proof);
    if (!proved)
        fprintf(stderr, "check_drat: line %llu %s\n", (unsigned long long)checker.line, checker.finding);
    drat_release(&checker);
    free(formula);
    free(proof);
    return !proved;
}
