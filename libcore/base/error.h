/* Errors: one status a kind of failure, one message a failure. */
#ifndef MESO_ERROR_H
#define MESO_ERROR_H

#ifdef __cplusplus
extern "C" {
#endif

/* The values are the exit codes of the tools. */
typedef enum MesoStatus {
    MESO_OK = 0,
    MESO_ERR_NO = 1,        /* the answer is no: proved unsolvable, check failed */
    MESO_ERR_USAGE = 2,     /* the caller asked for what does not exist */
    MESO_ERR_LIMIT = 3,     /* gave up at a limit; not a no */
    MESO_ERR_INPUT = 4,     /* an input is wrong */
    MESO_ERR_OUTPUT = 5,    /* an output cannot be written */
    MESO_ERR_INTERNAL = 6,  /* our mistake, or a library's */
    MESO_ERR_MEMORY = 33
} MesoStatus;

typedef struct MesoError {
    MesoStatus status;
    char message[512];
} MesoError;

/*
 * Fills `error` (which may be NULL) and returns `status`, so that a failing
 * function ends in `return meso_fail(...)`. The message says the failure
 * first, in lower case, without a full stop; what does not fit is cut off, and
 * control characters from hostile input become '?'.
 */
MesoStatus meso_fail(MesoError *error, MesoStatus status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Puts "`prefix`: " before the message of `error`; returns its status. */
MesoStatus meso_fail_prefix(MesoError *error, const char *prefix);

#ifdef __cplusplus
}
#endif

#endif
