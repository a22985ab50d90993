#include "cmd/common/progress.h"

#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { LINE_LENGTH = 79 };

static const uint64_t second = 1000000000;

static uint64_t now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (uint64_t)time.tv_sec * second + (uint64_t)time.tv_nsec;
}

/* One write, so that threads and other programs do not cut into the line. */
static void emit(const char *text)
{
    (void)!write(STDERR_FILENO, text, strlen(text));
}

static void format_time(char *out, unsigned size, double seconds)
{
    if (seconds < 100)
        snprintf(out, size, "%.0f s", seconds);
    else if (seconds < 100 * 60)
        snprintf(out, size, "%.0f min", seconds / 60);
    else
        snprintf(out, size, "%.0f h", seconds < 1e7 ? seconds / 3600 : 9999.);
}

void meso_progress_format(char *out, unsigned size, const char *what, const char *unit,
                          uint64_t done, uint64_t total, double seconds)
{
    static const char *const scales[] = {"", "k", "M", "G"};
    double rate = seconds > 0 ? (double)done / seconds : 0;
    double share = total ? (double)done / (double)total : 0;
    double left = done > 0 && done < total ? seconds * (1 / share - 1) : 0;
    char time[32];
    unsigned scale = 0;
    while (rate >= 1000 && scale < 3) {
        rate /= 1000;
        scale++;
    }
    format_time(time, sizeof time, left);
    snprintf(out, size, "%s %3.0f%% %.*f%s %s/s, %s left", what, share < 1 ? 100 * share : 100.,
             rate < 100 ? 1 : 0, rate, scales[scale], unit, time);
}

static void show_line(MesoProgress *progress, uint64_t done, uint64_t total, uint64_t time)
{
    char text[LINE_LENGTH + 1], line[LINE_LENGTH + 8];
    meso_progress_format(text, sizeof text, progress->what, progress->unit, done, total,
                         (double)(time - progress->start) / (double)second);
    snprintf(line, sizeof line, "\r%-*s", LINE_LENGTH, text);
    atomic_store(&progress->shown, true);
    emit(line);
}

static void show_json(const MesoProgress *progress, uint64_t done, uint64_t total)
{
    char line[256];
    snprintf(line, sizeof line, "{\"progress\":{\"what\":\"%s\",\"done\":%llu,\"total\":%llu}}\n",
             progress->what, (unsigned long long)done, (unsigned long long)total);
    emit(line);
}

void meso_progress_init(MesoProgress *progress, const char *mode, bool quiet)
{
    memset(progress, 0, sizeof *progress);
    if (mode && strcmp(mode, "json") == 0)
        progress->mode = MESO_PROGRESS_JSON;
    else if ((!mode || strcmp(mode, "auto") == 0) && !quiet && isatty(STDERR_FILENO))
        progress->mode = MESO_PROGRESS_LINE;
}

void meso_progress_begin(MesoProgress *progress, const char *what, const char *unit)
{
    meso_progress_end(progress);
    progress->what = what;
    progress->unit = unit;
    progress->start = now();
    atomic_store(&progress->done, 0);
    atomic_store(&progress->total, 0);
    atomic_store(&progress->next,
                 progress->start + (progress->mode == MESO_PROGRESS_JSON ? second / 2 : second));
}

void meso_progress_update(MesoProgress *progress, uint64_t done, uint64_t total)
{
    if (progress->mode == MESO_PROGRESS_NONE || !progress->what)
        return;
    atomic_store(&progress->done, done);
    atomic_store(&progress->total, total);
    bool json = progress->mode == MESO_PROGRESS_JSON;
    uint64_t time = now();
    uint_fast64_t due = atomic_load(&progress->next);
    if (time < due || !atomic_compare_exchange_strong(&progress->next, &due,
                                                      time + (json ? second / 2 : second / 10)))
        return;
    if (json)
        show_json(progress, done, total);
    else
        show_line(progress, done, total, time);
}

void meso_progress_hide(MesoProgress *progress)
{
    if (!atomic_exchange(&progress->shown, false))
        return;
    char line[LINE_LENGTH + 8];
    snprintf(line, sizeof line, "\r%*s\r", LINE_LENGTH, "");
    emit(line);
}

void meso_progress_end(MesoProgress *progress)
{
    if (progress->what && progress->mode == MESO_PROGRESS_JSON)
        show_json(progress, atomic_load(&progress->done), atomic_load(&progress->total));
    meso_progress_hide(progress);
    progress->what = NULL;
}
