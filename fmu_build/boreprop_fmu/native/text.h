/* Text of the FMU's edge, always UTF-8: messages of one line, file names, numbers that people wrote. */
#ifndef BOREPROP_TEXT_H
#define BOREPROP_TEXT_H

#include "sentence.h"
#include <stdarg.h>
#include <stdint.h>

enum { LINE = 2048, SHOWN = 80 };

/* The code point at `*text`, which moves on behind it; −1 if the bytes there are not UTF-8. */
static long next_character(const char **text) {
    static const long LEAST[] = {0, 0x80, 0x800, 0x10000};
    unsigned char first = (unsigned char)*(*text)++;
    int more = first < 0x80 ? 0 : first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : 1;
    if (first >= 0x80 && (first < 0xC0 || first >= 0xF8)) return -1;
    long point = more ? first & (0x3F >> more) : first;
    for (int i = 0; i < more; i++) {
        if (((unsigned char)**text & 0xC0) != 0x80) return -1;
        point = point << 6 | ((unsigned char)*(*text)++ & 0x3F);
    }
    return point < LEAST[more] || point > 0x10FFFF || (point >= 0xD800 && point < 0xE000) ? -1 : point;
}

static int is_utf8(const char *text) {
    while (*text)
        if (next_character(&text) < 0) return 0;
    return 1;
}

/* Text between quotes for a message: a long one by its beginning, what cannot be read as ?. */
static const char *quoted(const char *text, char shown[SHOWN]) {
    char *to = shown;
    *to++ = '\'';
    while (*text && to < shown + SHOWN - 10) {
        const char *from = text;
        long point = next_character(&text);
        if (point < 0x20 || point == 0x7F) *to++ = '?';
        else
            while (from < text) *to++ = *from++;
    }
    strcpy(to, *text ? "…'" : "'");
    return shown;
}

/* Format a line; where it is too long it ends after a whole character, and a line break in it is a ?. Gives 0, for
   `return explain(why, …)`. */
static int explain(char why[LINE], const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(why, LINE, format, arguments);
    va_end(arguments);
    if (length >= LINE) {
        char *end = why + LINE - 1;
        while (((unsigned char)*--end & 0xC0) == 0x80) continue;
        *end = '\0';
    }
    for (; *why; why++)
        if (*why == '\n' || *why == '\r') *why = '?';
    return 0;
}

/* A problem as the line that says what it is; gives 0, for `return tell(…)`. */
static int tell(const Problem *problem, char why[LINE]) {
    char line[MESSAGE];
    return explain(why, "%s", sentence(problem, line));
}

/* Whether the text is a decimal number and nothing else; `value` is it, whatever the locale's decimal point. */
static int parse_number(const char *text, double *value) {
    char point[8], number[128], *to = number;
    const char *digits = "0123456789", *space = " \t\v\f\r\n";
    size_t length, count = 0;
    snprintf(point, sizeof point, "%.1f", 0.5);
    point[strlen(point) - 1] = '\0'; /* "0.5" without the digits around the point */
    text += strspn(text, space);
    if (strlen(text) > sizeof number - sizeof point) return 0;
    if (*text == '+' || *text == '-') *to++ = *text++;
    for (int fraction = 0; fraction < 2; fraction++) {
        if (fraction && *text != '.') break;
        if (fraction) text++, to += strlen(strcpy(to, point + 1));
        count += length = strspn(text, digits);
        memcpy(to, text, length);
        to += length, text += length;
    }
    if (!count) return 0;
    if (*text == 'e' || *text == 'E') {
        *to++ = *text++;
        if (*text == '+' || *text == '-') *to++ = *text++;
        if (!(length = strspn(text, digits))) return 0;
        memcpy(to, text, length);
        to += length, text += length;
    }
    *to = '\0';
    *value = strtod(number, NULL);
    return text[strspn(text, space)] == '\0';
}

#endif
