/* Files of lines: appended as they come, to what is there; failures by name. */
#include "formats/file/line_file.h"

#include "formats/file/test_folder.h"

int main(void)
{
    TestFolder folder = test_folder_make();
    const char *path = test_path(&folder, "lines");
    MesoLineFile lines;
    MesoInput input;
    MesoError error;
    CHECK(meso_line_file_open(&lines, path, &error) == MESO_OK);
    CHECK(meso_line_file_append(&lines, "one", &error) == MESO_OK);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);    /* before it is closed */
    CHECK(input.size == 4 && memcmp(input.data, "one\n", 4) == 0);
    meso_input_close(&input);
    CHECK(meso_line_file_append(&lines, "", &error) == MESO_OK);
    CHECK(meso_line_file_close(&lines, &error) == MESO_OK);
    CHECK(meso_line_file_open(&lines, path, &error) == MESO_OK);
    CHECK(meso_line_file_append(&lines, "three", &error) == MESO_OK);
    CHECK(meso_line_file_close(&lines, &error) == MESO_OK);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    CHECK(input.size == 11 && memcmp(input.data, "one\n\nthree\n", 11) == 0);
    meso_input_close(&input);

    CHECK(meso_line_file_open(&lines, test_path(&folder, "no/such"), &error) == MESO_ERR_OUTPUT);
    CHECK(strstr(error.message, "/no/such': No such file or directory") != NULL);
    if (access("/dev/full", W_OK) == 0) {
        CHECK(meso_line_file_open(&lines, "/dev/full", &error) == MESO_OK);
        CHECK(meso_line_file_append(&lines, "x", &error) == MESO_ERR_OUTPUT);
        CHECK(strcmp(error.message, "cannot write '/dev/full': No space left on device") == 0);
        CHECK(meso_line_file_close(&lines, &error) == MESO_OK);
    }
    test_folder_remove(&folder);
    return 0;
}
