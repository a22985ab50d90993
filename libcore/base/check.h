/*
 * The check macros of the unit tests: live in every configuration. A test is a
 * small program that is silent and returns 0 when all holds.
 */
#ifndef MESO_CHECK_H
#define MESO_CHECK_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition)                                                          \
    do {                                                                          \
        if (!(condition)) {                                                       \
            fprintf(stderr, "%s:%d: check failed: %s\n", __FILE__, __LINE__, #condition); \
            exit(1);                                                              \
        }                                                                         \
    } while (0)

/* That two strings are the same. */
#define CHECK_TEXT(text, expected)                                                \
    do {                                                                          \
        if (strcmp(text, expected) != 0) {                                        \
            fprintf(stderr, "%s:%d: got '%s', not '%s'\n", __FILE__, __LINE__, text, expected); \
            exit(1);                                                              \
        }                                                                         \
    } while (0)

#endif
