/* The sentence that says what a problem is. */
#ifndef BOREPROP_SENTENCE_H
#define BOREPROP_SENTENCE_H

#include "checks.h"

enum { MESSAGE = 512, FIELD = 128 }; /* bytes: of a sentence, and of the text in place of a field */

/* The text that takes the place of a field of a sentence, such as "{limit}". */
static inline const char *field_text(const Problem *problem, const char *field, char text[FIELD]) {
    const char *name = NAME[problem->quantity];
    if (!strncmp(field, "{value}", 7)) return represent(problem->value, text);
    if (!strncmp(field, "{before}", 8)) return represent(problem->before, text);
    if (!strncmp(field, "{count}", 7)) return decimal(problem->value, 6, text);
    if (!strncmp(field, "{limit}", 7)) return decimal(problem->limit, 6, text);
    if (!strncmp(field, "{unit}", 6)) return IS_ANGLE[problem->quantity] ? " rad" : "";
    if (!strncmp(field, "{place}", 7)) return decimal(problem->place, 9, text);
    snprintf(text, FIELD, problem->index ? "%s[%d]" : "%s", name, problem->index);
    return text;
}

/* What is wrong, in one line. */
static inline const char *sentence(const Problem *problem, char line[MESSAGE]) {
    char text[FIELD], *to = line;
    for (const char *from = SENTENCE[problem->code]; *from; from++) {
        if (*from != '{') {
            *to++ = *from;
            continue;
        }
        to += strlen(strcpy(to, field_text(problem, from, text)));
        from = strchr(from, '}');
    }
    *to = '\0';
    return line;
}

#endif
