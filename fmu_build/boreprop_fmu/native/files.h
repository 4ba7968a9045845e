/* Files of text, and the URI by which a host names a folder of them. */
#ifndef BOREPROP_FILES_H
#define BOREPROP_FILES_H

#include "text.h"
#include <errno.h>
#ifndef _WIN32
#include <sys/stat.h>
#endif

enum { LARGEST = 1 << 26 }; /* bytes of a file */

static FILE *open_file(const char *path) {
#ifdef _WIN32
    wchar_t wide[LINE], *to = wide;
    while (*path && to < wide + LINE - 2) {
        long point = next_character(&path);
        if (point >= 0x10000) *to++ = (wchar_t)(0xD800 + ((point - 0x10000) >> 10));
        *to++ = (wchar_t)(point >= 0x10000 ? 0xDC00 + (point & 0x3FF) : point);
    }
    *to = L'\0';
    return _wfopen(wide, L"rb");
#else
    return fopen(path, "rb");
#endif
}

/* Whether a path is that of a pipe or a device, from which reading might never end. */
static int is_special(const char *path) {
#ifdef _WIN32
    (void)path;
    return 0;
#else
    struct stat about;
    return !stat(path, &about) && !S_ISREG(about.st_mode) && !S_ISDIR(about.st_mode);
#endif
}

/* The whole content of a file, to be freed, and its `size`; NULL if it is too large for the memory or for us. */
static char *read_all(FILE *file, size_t *size) {
    size_t room = 1 << 14;
    char *text = malloc(room);
    *size = 0;
    while (text) {
        *size += fread(text + *size, 1, room - *size - 1, file);
        text[*size] = '\0';
        if (*size + 1 < room) return text;
        char *more = room < LARGEST ? realloc(text, room *= 2) : NULL;
        if (!more) free(text);
        text = more;
    }
    return NULL;
}

/* The text of a file of some kind, to be freed; NULL with `why` if it cannot be read or is no text. */
static char *read_text(const char *path, const char *kind, char why[LINE]) {
    const char *fault = NULL;
    size_t size = 0;
    errno = 0;
    FILE *file = is_special(path) ? NULL : open_file(path);
    char *text = file ? read_all(file, &size) : NULL;
    if (!file && is_special(path)) fault = "a pipe or a device";
    else if (!file || ferror(file)) fault = strerror(errno);
    else if (!text) fault = "more than fits into the memory, or than 64 MB";
    else if (strlen(text) != size || !is_utf8(text)) fault = "bytes that are no UTF-8 text";
    if (file) fclose(file);
    if (!fault) return text;
    free(text);
    explain(why, "%s: must be a readable %s file, got: %s", path, kind, fault);
    return NULL;
}

/* The value of a hexadecimal digit; −1 if it is none. */
static int hexadecimal(char digit) {
    static const char digits[] = "0123456789abcdef0123456789ABCDEF";
    const char *found = digit ? strchr(digits, digit) : NULL;
    return found ? (int)(found - digits) % 16 : -1;
}

/* Whether a text begins like this, in small letters or capitals. */
static int begins(const char *text, const char *small) {
    for (; *small; text++, small++)
        if (*text != *small && !(*small >= 'a' && *small <= 'z' && *text == *small - 'a' + 'A')) return 0;
    return 1;
}

/* The path of a file in the folder that a host names: file:///folder, file:/folder, file://localhost/folder, with
   escapes as %20; what is no URI of the scheme "file" is taken for the path of the folder. 0 with `why` if it cannot
   be one. */
static int path_in(const char *folder, const char *file, char path[LINE], char why[LINE]) {
    char shown[SHOWN], *to = path;
    const char *from = folder ? folder : "";
    int escaped = begins(from, "file:");
    if (escaped) from += strlen("file:");
    if (escaped && begins(from, "//localhost/")) from += strlen("//localhost");
    else if (escaped && begins(from, "///")) from += strlen("//");
    for (; *from && to < path + LINE - 1; to++) {
        int high = escaped && *from == '%' ? hexadecimal(from[1]) : -1, low = high >= 0 ? hexadecimal(from[2]) : -1;
        if (escaped && *from == '%' && low < 0) break;
        *to = low < 0 ? *from : (char)(16 * high + low);
        if (!*to) break;
        from += low < 0 ? 1 : 3;
    }
    *to = '\0';
#ifdef _WIN32 /* "/C:/folder" and, from hosts that forget a slash, "//C:/folder" */
    const char *drive = path + strspn(path, "/");
    if (escaped && *drive && drive[1] == ':') memmove(path, drive, strlen(drive) + 1);
#endif
    if (to > path && !*from && is_utf8(path) && strlen(path) + strlen(file) + 2 < LINE) {
        strcat(strcat(path, "/"), file);
        return 1;
    }
    quoted(folder ? folder : "", shown);
    return explain(why, "fmuResourceLocation: must be the URI of a folder, file:///…, got %s", folder ? shown : "NULL");
}

#endif
