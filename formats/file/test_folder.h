/* For tests that need files: a fresh folder, removed with all in it at the end. */
#ifndef MESO_TEST_FOLDER_H
#define MESO_TEST_FOLDER_H

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "formats/file/input.h"
#include "libcore/base/check.h"

typedef struct TestFolder {
    char path[64];
} TestFolder;

static inline TestFolder test_folder_make(void)
{
    TestFolder folder = {"/tmp/meso-test-XXXXXX"};
    CHECK(mkdtemp(folder.path) != NULL);
    return folder;
}

/* Path of `name` in the folder; good until the eighth call after. */
static inline const char *test_path(const TestFolder *folder, const char *name)
{
    static char paths[8][512];
    static int next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", folder->path, name);
    return path;
}

/* Entries of the folder, hidden ones too. */
static inline int test_folder_count(const TestFolder *folder)
{
    int count = 0;
    DIR *list = opendir(folder->path);
    CHECK(list != NULL);
    while (readdir(list))
        count++;
    closedir(list);
    return count - 2;   /* . and .. */
}

static inline void test_folder_remove(const TestFolder *folder)
{
    DIR *list = opendir(folder->path);
    CHECK(list != NULL);
    for (struct dirent *entry; (entry = readdir(list));)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
            const char *path = test_path(folder, entry->d_name);
            CHECK(unlink(path) == 0 || rmdir(path) == 0);
        }
    closedir(list);
    CHECK(rmdir(folder->path) == 0);
}

static inline void test_file_write(const char *path, const void *data, size_t size)
{
    FILE *file = fopen(path, "wb");
    CHECK(file && fwrite(data, 1, size, file) == size && fclose(file) == 0);
}

/* True if the file holds exactly these bytes. */
static inline bool test_file_is(const char *path, const void *data, size_t size)
{
    MesoInput input;
    MesoError error;
    if (meso_input_open(&input, path, &error) != MESO_OK)
        return false;
    bool same = input.size == size && memcmp(input.data, data, size) == 0;
    meso_input_close(&input);
    return same;
}

#endif
