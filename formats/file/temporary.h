/*
 * Temporary files of outputs, and their names for signal handlers: whatever
 * signal comes when, to whichever of many threads, none of the files stays.
 */
#ifndef MESO_TEMPORARY_H
#define MESO_TEMPORARY_H

#include <stdbool.h>

typedef int MesoTemporary;      /* entry in the table of names, or MESO_NO_TEMPORARY */

enum { MESO_NO_TEMPORARY = -1 };

/*
 * Creates a hidden file in the folder that is the first `length` bytes of `near` ("" for the current
 * one, else with its slash) and opens it for reading and writing. Returns the descriptor, or -1 with
 * errno; EMFILE where 64 are there already.
 */
int meso_temporary_create(MesoTemporary *temporary, const char *near, int length);

/* Moves the file to `target`; its name is then forgotten. False with errno. */
bool meso_temporary_rename(MesoTemporary *temporary, const char *target);

/* Takes the file's name away; an open descriptor stays good. Nothing where there is none. */
void meso_temporary_remove(MesoTemporary *temporary);

/*
 * Removes every file that there is, and stops for good every thread that would
 * create, rename or remove another one: for the handler of a signal that the
 * process then dies of. Async-signal-safe.
 */
void meso_temporary_remove_all(void);

#endif
