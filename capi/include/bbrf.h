/* The validator of bbrf files, for C and everything that calls C.
 *
 * Build it with `cargo build --release --package bbrf-capi`: target/release has libbbrf.so (libbbrf.dylib, bbrf.dll) and
 * libbbrf.a, which need no other library. Files are read in pure Rust: a damaged one neither crashes nor hangs the caller.
 * With --no-default-features no C compiler is needed, and the one rule `structure.bytes` is not applied. All functions may
 * be called from several threads at once.
 */
#ifndef BBRF_H
#define BBRF_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a validation returns; the same as the exit status of `bbrf validate`. */
#define BBRF_VALID 0      /* no finding of severity error */
#define BBRF_INVALID 1    /* read, and a finding of severity error */
#define BBRF_UNREADABLE 2 /* not read: no such file, damaged, or none of this standard */

/* Validates a file.
 *
 * path         its name, ending in NUL; bytes as the system has them on Unix, UTF-8 elsewhere.
 * json_report  NULL, or where the report goes: JSON in UTF-8 ending in NUL, as `bbrf validate --json` prints it
 *              (schema/validate.json). Free it with bbrf_free. It is NULL only after a defect of the library.
 */
int bbrf_validate(const char *path, char **json_report);

/* Validates a file in memory: `length` bytes, which must not change meanwhile. The report calls it `(bytes)`. */
int bbrf_validate_bytes(const uint8_t *bytes, size_t length, char **json_report);

/* Frees a report; NULL is nothing to free. */
void bbrf_free(char *json_report);

/* The version of the library, as "0.1.0"; not to be freed. */
const char *bbrf_version(void);

#ifdef __cplusplus
}
#endif

#endif
