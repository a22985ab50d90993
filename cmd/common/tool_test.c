/* The frame of the tools, run in children as a shell would run them. */
#include "cmd/common/tool.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>

#include "formats/file/test_folder.h"
#include "formats/json/json_text.h"

static const MesoToolInfo info = {
    .name = "meso-try",
    .synopsis = "meso-try [options] FILE\nmeso-try --all",
    .purpose = "Tries things.",
    .examples = "meso-try -o out in",
    .operands_low = 1,
    .operands_high = 2,
};

/* Reads a file of two pages after it was cut to one. */
static MesoStatus read_cut(MesoError *error)
{
    MesoInput input;
    MesoStatus status = meso_input_open(&input, "cut", error);
    if (status)
        return status;
    CHECK(truncate("cut", 4096) == 0);
    volatile uint8_t last = input.data[input.size - 1];
    return meso_fail(error, MESO_ERR_INTERNAL, "read %u", last);
}

/* Operand "ok", "no", "write" (to -o), "cut", or "sleep" (both with an output open). */
static MesoStatus run(MesoTool *tool, MesoError *error)
{
    const char *what = tool->operands[0];
    json_object_set_new(tool->report, "what", meso_json_string(what));
    meso_tool_progress_begin(tool, "trying", "times");
    meso_tool_progress(tool, 1, 2);
    meso_tool_say(tool, "trying\n%s", what);
    if (strcmp(what, "no") == 0)
        return meso_fail(error, MESO_ERR_NO, "it is not");
    if (strcmp(what, "ok") == 0)
        return MESO_OK;
    MesoOutput *output;
    MesoStatus status = meso_output_open(&output, tool->output, error);
    if (status)
        return status;
    status = meso_output_write(output, "product\n", 8, error);
    if (strcmp(what, "cut") == 0)
        return read_cut(error);
    if (strcmp(what, "sleep") == 0) {
        (void)!write(STDERR_FILENO, "ready", 5);
        sleep(20);
    }
    return meso_output_commit(output, error);
}

static int tool_main(int argc, char **argv)
{
    static MesoTool tool;
    tool = (MesoTool){0};
    MesoOption options[] = {MESO_TOOL_OPTIONS(tool), {0}};
    if (!meso_tool_start(&tool, &info, options, argc, argv))
        return meso_tool_finish(&tool);
    tool.status = run(&tool, &tool.error);
    return meso_tool_finish(&tool);
}

static TestFolder folder;
static char out[8192], err[8192];

static void slurp(const char *name, char *text, size_t size)
{
    int file = open(test_path(&folder, name), O_RDONLY);
    ssize_t got = read(file, text, size - 1);
    CHECK(file >= 0 && got >= 0);
    text[got] = 0;
    close(file);
    unlink(test_path(&folder, name));
}

static void redirect(int file, const char *path)
{
    int to = open(path, O_WRONLY | O_CREAT, 0600);
    CHECK(to >= 0 && dup2(to, file) == file);
    close(to);
}

/* Splits `line` at blanks; standard output to `to`, or to a file that ends up in `out`. */
static pid_t start(const char *line, const char *to)
{
    pid_t child = fork();
    if (child != 0)
        return child;
    static char copy[512];
    char *arguments[16];
    int count = 0;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word = strtok(copy, " "); word; word = strtok(NULL, " "))
        arguments[count++] = word;
    if (!to || *to)
        redirect(STDOUT_FILENO, to ? to : test_path(&folder, "stdout"));
    else
        close(STDOUT_FILENO);
    redirect(STDERR_FILENO, test_path(&folder, "stderr"));
    CHECK(chdir(folder.path) == 0);
    _exit(tool_main(count, arguments));
}

static int run_line(const char *line, const char *to)
{
    int status;
    *out = *err = 0;
    pid_t child = start(line, to);
    CHECK(waitpid(child, &status, 0) == child && WIFEXITED(status));
    if (!to)
        slurp("stdout", out, sizeof out);
    slurp("stderr", err, sizeof err);
    return WEXITSTATUS(status);
}

static void test_help(void)
{
    CHECK(run_line("meso-try --help", NULL) == 0 && *err == 0);
    CHECK(strncmp(out, "Usage:\n  meso-try [options] FILE\n  meso-try --all\n\nTries things.\n", 64) == 0);
    CHECK(strstr(out, "\n  -o, --output FILE       write the product there; - is standard output\n"));
    CHECK(strstr(out, "\n      --json[=FILE]       report"));
    CHECK(strstr(out, "\nExamples:\n  meso-try -o out in\n"));
    for (const char *line = out; *line; line += strcspn(line, "\n") + 1)
        CHECK(strcspn(line, "\n") <= 80);
    CHECK(run_line("meso-try --version", NULL) == 0 && strcmp(out, "meso-try " MESO_VERSION "\n") == 0);
    CHECK(run_line("meso-try --no-such -h --seed", NULL) == 0 && strncmp(out, "Usage:", 6) == 0);
    CHECK(run_line("meso-try --help", "/dev/full") == 5);
    CHECK(strcmp(err, "meso-try: cannot write standard output: No space left on device\n") == 0);
    CHECK(run_line("meso-try --help", "") == 5);
}

static void test_usage(void)
{
    CHECK(run_line("meso-try --no-such ok", NULL) == 2 && *out == 0);
    CHECK(strcmp(err, "meso-try: unknown option '--no-such'\ntry 'meso-try --help'\n") == 0);
    CHECK(run_line("meso-try", NULL) == 2);
    CHECK(strncmp(err, "meso-try: 0 operands given, at least 1 needed\n", 45) == 0);
    CHECK(run_line("meso-try a b c", NULL) == 2);
    CHECK(strncmp(err, "meso-try: 3 operands given, at most 2 needed\n", 45) == 0);
    CHECK(run_line("meso-try ok -o - --json", NULL) == 2 && strstr(err, "--json=FILE"));
    CHECK(run_line("", NULL) == 2);
}

static void test_run(void)
{
    CHECK(run_line("meso-try ok", NULL) == 0 && *out == 0);
    CHECK(strcmp(err, "meso-try: ok: trying?ok\n") == 0);
    CHECK(run_line("meso-try -q ok", NULL) == 0 && *out == 0 && *err == 0);
    CHECK(run_line("meso-try -q no", NULL) == 1 && strcmp(err, "meso-try: no: it is not\n") == 0);
    CHECK(run_line("meso-try -q no -o a\nb", NULL) == 1 && strcmp(err, "meso-try: a?b: it is not\n") == 0);
    CHECK(run_line("meso-try ok other -o -", NULL) == 0 && strcmp(err, "meso-try: other: trying?ok\n") == 0);
    CHECK(run_line("meso-try -q write -o -", NULL) == 0 && strcmp(out, "product\n") == 0);
    CHECK(run_line("meso-try -q write -o -", "/dev/full") == 5);
    CHECK(run_line("meso-try -q write -o -", "") == 5);
    CHECK(strcmp(err, "meso-try: cannot write standard output: Bad file descriptor\n") == 0);
    CHECK(run_line("meso-try -q write -o file", NULL) == 0);
    CHECK(test_file_is(test_path(&folder, "file"), "product\n", 8));
    unlink(test_path(&folder, "file"));
    CHECK(test_folder_count(&folder) == 0);
}

static void test_report(void)
{
    CHECK(run_line("dir/meso-try -q --threads 2 --json --seed=7 ok", NULL) == 0 && *err == 0);
    CHECK(strcmp(out, "{\n  \"format\": \"meso-report\",\n  \"version\": 1,\n  \"tool\": \"meso-try\",\n"
                      "  \"status\": \"ok\",\n  \"exit\": 0,\n  \"provenance\": {\n"
                      "    \"tool\": \"meso-try\",\n    \"version\": \"" MESO_VERSION "\",\n"
                      "    \"command\": \"meso-try --seed 7 ok\",\n    \"seed\": 7,\n"
                      "    \"inputs\": []\n  },\n  \"what\": \"ok\"\n}\n") == 0);
    CHECK(run_line("meso-try -v --json no", NULL) == 1);
    CHECK(strstr(out, "\"status\": \"no\",\n  \"exit\": 1,\n  \"message\": \"it is not\","));
    CHECK(strstr(out, "\"seconds\": "));
    CHECK(run_line("meso-try --json --nope a\xff\xfe", NULL) == 2 && strstr(out, "\"usage\""));
    CHECK(run_line("meso-try -q --json a\xff\xfe -o x", NULL) == 0);
    CHECK(strstr(out, "\"command\": \"meso-try 'a?""?'\""));
    CHECK(run_line("meso-try -q --json ../b/a\xff\xfe --provenance full -o x", NULL) == 0);
    CHECK(strstr(out, "\"command\": \"meso-try '../b/a?""?' -o x\""));
    CHECK(run_line("meso-try -q --json --seed=7 --provenance none ok", NULL) == 0);
    CHECK(strstr(out, "\"provenance\": {\"tool\": \"meso-try\", \"version\": \"" MESO_VERSION "\"},\n"));
    unlink(test_path(&folder, "x"));
    CHECK(run_line("meso-try -q --json=none/report ok", NULL) == 5);
    CHECK(strncmp(err, "meso-try: cannot write 'none/report': ", 38) == 0);
    CHECK(run_line("meso-try -q --json=none/report no", NULL) == 1);
    CHECK(run_line("meso-try -q --progress=json ok", NULL) == 0);
    CHECK(strcmp(err, "{\"progress\":{\"what\":\"trying\",\"done\":1,\"total\":2}}\n") == 0);
}

static void expect_file(const char *name, const char *text)
{
    CHECK(test_file_is(test_path(&folder, name), text, strlen(text)));
}

/* Neither the product nor the report may be what is read, whatever else is wrong. */
static void test_paths(void)
{
    test_file_write(test_path(&folder, "in"), "input", 5);
    CHECK(run_line("meso-try in -o ./in", NULL) == 2);
    CHECK(strcmp(err, "meso-try: -o './in' would write over the input 'in': name another file\n"
                      "try 'meso-try --help'\n") == 0);
    CHECK(run_line("meso-try in -o x --json=in", NULL) == 2 && run_line("meso-try --nope in --json=in", NULL) == 2);
    CHECK(run_line("meso-try in -o x --json=./x", NULL) == 2);
    CHECK(strstr(err, "-o and --json would both write './x', and one be lost"));
    CHECK(test_folder_count(&folder) == 1);
    expect_file("in", "input");
    /* The report of a refusal that it has no part in. */
    CHECK(run_line("meso-try in -o in --json=report", NULL) == 2 && test_folder_count(&folder) == 2);
    unlink(test_path(&folder, "report"));
    unlink(test_path(&folder, "in"));
}

static void test_signals(void)
{
    static const int signals[] = {SIGTERM, SIGINT, SIGHUP};
    for (int i = 0; i < 3; i++) {
        int status, ready = 0;
        signal(signals[i], SIG_DFL);            /* nohup has it ignored, and that is inherited */
        unlink(test_path(&folder, "stderr"));   /* the last one said "ready" there, too */
        pid_t child = start("meso-try -q sleep -o product", NULL);
        for (int wait = 0; wait < 500 && !ready; wait++) {
            nanosleep(&(struct timespec){0, 10000000}, NULL);
            ready = test_file_is(test_path(&folder, "stderr"), "ready", 5);
        }
        CHECK(ready && test_folder_count(&folder) == 3);
        CHECK(kill(child, signals[i]) == 0 && waitpid(child, &status, 0) == child);
        CHECK(WIFSIGNALED(status) && WTERMSIG(status) == signals[i]);
        CHECK(test_folder_count(&folder) == 2);     /* stdout and stderr */
    }
}

static void test_cut_input(void)
{
    static const char pages[8192];
    MesoOutput *output;
    MesoError error;
    CHECK(meso_output_open(&output, test_path(&folder, "cut"), &error) == MESO_OK);
    CHECK(meso_output_write(output, pages, sizeof pages, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(run_line("meso-try -q cut -o product", NULL) == 4 && *out == 0);
    CHECK(strcmp(err, "meso-try: 'cut' became shorter while it was read\n") == 0);
    CHECK(test_folder_count(&folder) == 1);     /* the input */
    unlink(test_path(&folder, "cut"));
}

int main(void)
{
    folder = test_folder_make();
    test_help();
    test_usage();
    test_run();
    test_report();
    test_paths();
    test_signals();
    test_cut_input();
    test_folder_remove(&folder);
    return 0;
}
