/* Validates the file it is called with, by name and from memory, and says what came out. Run by tests/c_abi.rs. */
#include "bbrf.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int from_memory(const char *path, char **report)
{
    static uint8_t bytes[1 << 24];
    FILE *file = fopen(path, "rb");
    size_t length = file ? fread(bytes, 1, sizeof bytes, file) : 0;
    if (file) {
        fclose(file);
    }
    return bbrf_validate_bytes(bytes, length, report);
}

int main(int count, char **arguments)
{
    char *by_name = NULL, *by_bytes = NULL;
    int status, again;
    if (count != 2) {
        return 9;
    }
    status = bbrf_validate(arguments[1], &by_name);
    again = from_memory(arguments[1], &by_bytes);
    if (status != again || !by_name || !by_bytes || !strstr(by_bytes, "(bytes)")) {
        return 8;
    }
    /* No report wanted, no file named, nothing to free: none of it is an error of the program. */
    if (bbrf_validate(arguments[1], NULL) != status || bbrf_validate(NULL, NULL) != BBRF_UNREADABLE
        || bbrf_validate_bytes(NULL, 12, NULL) != BBRF_UNREADABLE) {
        return 7;
    }
    bbrf_free(NULL);
    printf("%s\n%s", bbrf_version(), by_name);
    bbrf_free(by_name);
    bbrf_free(by_bytes);
    return status;
}
