/* Progress: the line's text, and how often JSON lines come. */
#include "cmd/common/progress.h"

#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "libcore/base/check.h"
#include "libcore/base/clock.h"

static void expect(const char *text, uint64_t done, uint64_t total, double seconds)
{
    char out[80];
    meso_progress_format(out, sizeof out, "mapping", "slots", done, total, seconds);
    CHECK_TEXT(out, text);
}

static void test_text(void)
{
    expect("mapping  25% 12.5 slots/s, 6 s left", 25, 100, 2);
    expect("mapping  50% 250k slots/s, 4 s left", 1000000, 2000000, 4);
    expect("mapping   1% 1.5M slots/s, 17 min left", 15000000, 1515000000, 10);
    expect("mapping 100% 10.0 slots/s, 0 s left", 100, 100, 10);
    expect("mapping   0% 0.0 slots/s, 0 s left", 0, 100, 0);
    expect("mapping   0% 5.0 slots/s, 0 s left", 5, 0, 1);
    expect("mapping   0% 1.0 slots/s, 9999 h left", 1, 1000000000000, 1);
    char small[8];
    meso_progress_format(small, sizeof small, "mapping", "slots", 1, 2, 1);
    CHECK(strlen(small) == 7);
}

/* Runs `update` many times with standard error in a pipe; what came is in `text`, and the seconds that it took come back. */
static double capture(const char *mode, bool quiet, char *text, size_t size)
{
    int ends[2], saved = dup(STDERR_FILENO);
    CHECK(saved >= 0 && pipe(ends) == 0 && dup2(ends[1], STDERR_FILENO) == STDERR_FILENO);
    MesoProgress progress;
    meso_progress_init(&progress, mode, quiet);
    meso_progress_update(&progress, 1, 2);      /* nothing under way */
    double start = meso_seconds();
    meso_progress_begin(&progress, "one", "things");
    for (uint64_t i = 1; i <= 70; i++) {
        meso_progress_update(&progress, i, 70);
        nanosleep(&(struct timespec){0, 10000000}, NULL);
    }
    meso_progress_begin(&progress, "two", "things");
    meso_progress_end(&progress);
    meso_progress_end(&progress);
    double seconds = meso_seconds() - start;
    CHECK(dup2(saved, STDERR_FILENO) == STDERR_FILENO);
    close(saved);
    close(ends[1]);
    ssize_t got = read(ends[0], text, size - 1);
    CHECK(got >= 0);
    text[got] = 0;
    close(ends[0]);
    return seconds;
}

static void test_json(void)
{
    char text[4096];
    double seconds = capture("json", true, text, sizeof text);
    int lines = 0;
    for (const char *c = text; *c; c++)
        lines += *c == '\n';
    /* after each half of a second, however long a busy machine takes; the end of one, the end of two */
    CHECK(lines >= 3 && lines <= 2 + (int)(2 * seconds));
    CHECK(strncmp(text, "{\"progress\":{\"what\":\"one\",\"done\":", 33) == 0);
    CHECK(strstr(text, "{\"progress\":{\"what\":\"one\",\"done\":70,\"total\":70}}\n"));
    CHECK(strstr(text, "{\"progress\":{\"what\":\"two\",\"done\":0,\"total\":0}}\n"));
}

int main(void)
{
    char text[256];
    test_text();
    test_json();
    capture("none", false, text, sizeof text);
    CHECK(*text == 0);
    capture("auto", false, text, sizeof text);      /* no terminal */
    CHECK(*text == 0);
    return 0;
}
