#include "libcore/base/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* File names and keys come from outside: a message stays on its one line. */
static void blank_controls(char *text)
{
    for (; *text; text++)
        if ((unsigned char)*text < 0x20 || *text == 0x7f)
            *text = '?';
}

MesoStatus meso_fail(MesoError *error, MesoStatus status, const char *format, ...)
{
    if (!error)
        return status;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
    blank_controls(error->message);
    error->status = status;
    return status;
}

MesoStatus meso_fail_prefix(MesoError *error, const char *prefix)
{
    if (!error)
        return MESO_ERR_INTERNAL;
    char old[sizeof error->message];
    memcpy(old, error->message, sizeof old);
    return meso_fail(error, error->status, "%s: %s", prefix, old);
}
