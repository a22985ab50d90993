/* JSON text: errors with their place, depth, numbers, layout. */
#include "formats/json/json_text.h"

#include <float.h>
#include <math.h>

#include "formats/file/test_folder.h"

static MesoStatus parse(const char *text, json_t **root, MesoError *error)
{
    MesoInput input;
    meso_input_wrap(&input, "file", text, strlen(text));
    return meso_json_parse(root, &input, error);
}

static void expect_error(const char *text, const char *begin)
{
    json_t *root = (json_t *)&root;
    MesoError error;
    CHECK(parse(text, &root, &error) == MESO_ERR_INPUT && root == NULL);
    if (strncmp(error.message, begin, strlen(begin)) != 0)
        fprintf(stderr, "%s\n", error.message);
    CHECK(strncmp(error.message, begin, strlen(begin)) == 0);
}

static void test_errors(void)
{
    expect_error("", "file:1:1: ");
    expect_error("{\"a\": 1,\n \"b\": x}", "file:2:7: ");
    expect_error("{\"a\": 1,\n \"a\": 2}", "file:2:4: duplicate object key");
    expect_error("[1] 2", "file:1:5: end of file expected");
    expect_error("[1, 2", "file:1:5: ");
    expect_error("7", "file:1:1: '[' or '{' expected");
    expect_error("[\"\xff\"]", "file:1:");
    expect_error("[1e999]", "file:1:6: real number overflow");
    expect_error("[\"a\\u0000\"]", "file:1:");

    MesoInput input;
    MesoError error;
    json_t *root;
    meso_input_wrap(&input, "file", "[1]\0", 4);
    CHECK(meso_json_parse(&root, &input, &error) == MESO_ERR_INPUT);
    meso_input_wrap(&input, "file", "[1,\n 2\0]", 8);     /* which Jansson takes */
    CHECK(meso_json_parse(&root, &input, &error) == MESO_ERR_INPUT && !root);
    CHECK(strcmp(error.message, "file:2:3: a zero byte, which is not text") == 0);
    CHECK(meso_json_parse_line(&root, "file", 7, "[1, x]", 6, &error) == MESO_ERR_INPUT && !root);
    CHECK(strncmp(error.message, "file:7:5: ", 10) == 0);
    const char whole[] = "{\"a\": [1, 2.5, \"x\\ty\", true, null]}";
    for (size_t size = 0; size + 1 < sizeof whole - 1; size++) {
        meso_input_wrap(&input, "file", whole, size);
        CHECK(meso_json_parse(&root, &input, &error) == MESO_ERR_INPUT && !root);
    }
}

/* A byte order mark is no part of the text, and none within it is passed over. */
static void test_mark(void)
{
    MesoInput input;
    MesoError error;
    json_t *root;
    static const char marked[] = "\xef\xbb\xbf{\"a\": 1}", twice[] = "\xef\xbb\xbf\xef\xbb\xbf{}";
    meso_input_wrap(&input, "x.json", marked, sizeof marked - 1);
    CHECK(meso_json_parse(&root, &input, &error) == MESO_OK);
    CHECK(json_integer_value(json_object_get(root, "a")) == 1);
    json_decref(root);
    meso_input_wrap(&input, "x.json", twice, sizeof twice - 1);
    CHECK(meso_json_parse(&root, &input, &error) == MESO_ERR_INPUT);
    meso_input_wrap(&input, "x.json", marked, 3);
    CHECK(meso_json_parse(&root, &input, &error) == MESO_ERR_INPUT);
}

static void test_depth(void)
{
    char text[2 * 600 + 16];
    json_t *root;
    MesoError error;
    memset(text, '[', 512);
    memset(text + 512, ']', 512);
    text[1024] = 0;
    CHECK(parse(text, &root, &error) == MESO_OK);
    json_decref(root);

    memset(text, '[', 513);
    text[513] = 0;
    expect_error(text, "file:1:513: more than 512 levels of nesting");
    text[0] = '\n';
    text[513] = '[';
    text[514] = 0;
    expect_error(text, "file:2:513: more than 512 levels of nesting");

    /* Brackets in strings, after an escaped quote too, and closed ones do not count. */
    char *out = text;
    *out++ = '[';
    *out++ = '"';
    *out++ = '\\';
    *out++ = '"';
    memset(out, '{', 600);
    strcpy(out + 600, "\"]");
    CHECK(parse(text, &root, &error) == MESO_OK);
    json_decref(root);
    out = text;
    *out++ = '[';
    for (int i = 0; i < 300; i++)
        out += sprintf(out, "%s[]", i ? "," : "");
    strcpy(out, "]");
    CHECK(parse(text, &root, &error) == MESO_OK);
    json_decref(root);
}

static void expect_text(const TestFolder *folder, json_t *value, const char *text)
{
    MesoOutput *output;
    MesoError error;
    const char *path = test_path(folder, "out.json");
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_json_write(value, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(test_file_is(path, text, strlen(text)));
    json_decref(value);
}

static void test_layout(const TestFolder *folder)
{
    expect_text(folder, json_object(), "{}\n");
    expect_text(folder, json_array(), "[]\n");
    expect_text(folder, json_pack("[i,f,s,b,n]", -3, 0.1, "a\"\n\xc3\xa9", 1),
                "[-3, 0.1, \"a\\\"\\n\xc3\xa9\", true, null]\n");
    expect_text(folder, json_pack("[f,f,f]", 2.0, 1e300, -0.0), "[2.0, 1e+300, -0.0]\n");
    expect_text(folder, json_pack("{s:s,s:[i,i],s:{s:[]},s:[{s:i},{}]}", "z", "first", "a", 1, 2,
                                  "b", "c", "d", "e", 1),
                "{\n  \"z\": \"first\",\n  \"a\": [1, 2],\n  \"b\": {\"c\": []},\n"
                "  \"d\": [\n    {\"e\": 1},\n    {}\n  ]\n}\n");
    json_t *longer = json_array();
    for (int i = 0; i < 40; i++)
        json_array_append_new(longer, json_integer(i));
    char expected[400] = "[";
    for (int i = 0; i < 40; i++)
        sprintf(expected + strlen(expected), "%s\n  %d", i ? "," : "", i);
    strcat(expected, "\n]\n");
    expect_text(folder, longer, expected);

    MesoError error;
    CHECK(meso_json_write(NULL, NULL, &error) == MESO_ERR_MEMORY);
}

static void test_numbers_come_back(const TestFolder *folder)
{
    static const double values[] = {0.1, 1.0 / 3, 0.02f, DBL_MAX, DBL_MIN, 5e-324, 123456789.125,
                                    1e22, 6.02214076e23, 0.30000000000000004};
    json_t *list = json_array(), *back;
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        json_array_append_new(list, json_real(values[i]));
    MesoOutput *output;
    MesoError error;
    MesoInput input;
    const char *path = test_path(folder, "numbers.json");
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(meso_json_write(list, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(meso_json_parse(&back, &input, &error) == MESO_OK && json_equal(list, back));
    meso_input_close(&input);
    json_decref(list);
    json_decref(back);
}

static void test_format(void)
{
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"{}", "file: no \"format\"; a 'kind' file is needed here"},
        {"[]", "file: no \"format\"; a 'kind' file is needed here"},
        {"{\"format\": \"other\"}", "file: is a 'other' file; a 'kind' file is needed here"},
        {"{\"format\": \"kind\"}", "file: \"version\" must be a whole number from 1"},
        {"{\"format\": \"kind\", \"version\": 0}", "file: \"version\" must be a whole number from 1"},
        {"{\"format\": \"kind\", \"version\": 3}",
         "file: version 3 is newer than this program reads (2)"},
        {"{\"format\": \"kind\", \"version\": 2}", NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        json_t *root;
        MesoError error = {0};
        CHECK(parse(cases[i].text, &root, &error) == MESO_OK);
        MesoStatus status = meso_json_check_format(root, "file", "kind", 2, &error);
        CHECK((status == MESO_OK) == !cases[i].message);
        CHECK(!cases[i].message || strcmp(error.message, cases[i].message) == 0);
        json_decref(root);
    }
}

static void test_strings(void)
{
    json_t *value = meso_json_string("a\xc3\xa9");
    CHECK(strcmp(json_string_value(value), "a\xc3\xa9") == 0);
    json_decref(value);
    value = meso_json_string("a\xff\xc3z");
    CHECK(strcmp(json_string_value(value), "a??z") == 0);
    json_decref(value);
}

static void test_floats(void)
{
    static const struct {
        float value;
        double shown;
    } rows[] = {{0.1f, 0.1}, {-0.0f, 0}, {16777216, 16777216}, {1.0f / 3, 0.33333334}, {1e-45f, 1e-45}, {-2.5e30f, -2.5e30}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        json_t *value = meso_json_shortest(rows[i].value);
        CHECK(json_real_value(value) == rows[i].shown && !signbit(json_real_value(value)) == (rows[i].shown >= 0));
        json_decref(value);
    }
    CHECK(!meso_json_shortest(NAN) && !meso_json_shortest(INFINITY));
}

int main(void)
{
    TestFolder folder = test_folder_make();
    test_errors();
    test_mark();
    test_depth();
    test_layout(&folder);
    test_numbers_come_back(&folder);
    test_format();
    test_strings();
    test_floats();
    test_folder_remove(&folder);
    return 0;
}
