/* What a library for Windows needs besides Windows' own C library, ucrtbase.dll, which does not export the standard's
   functions that format. MinGW's start-up code and additions are not linked: zig would take a minute or two to compile
   them all. */
#include <stdarg.h>
#include <stdio.h>

int vsnprintf(char *text, size_t size, const char *format, va_list arguments) {
    const unsigned long long standard = _CRT_INTERNAL_PRINTF_STANDARD_SNPRINTF_BEHAVIOR;
    return __stdio_common_vsprintf(standard, text, size, format, NULL, arguments);
}

int snprintf(char *text, size_t size, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, size, format, arguments);
    va_end(arguments);
    return length;
}

/* There is nothing to start: no constructors, no variables of a thread. */
int __stdcall _DllMainCRTStartup(void *library, unsigned long reason, void *reserved) {
    (void)library, (void)reason, (void)reserved;
    return 1;
}
