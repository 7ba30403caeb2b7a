// The one translation unit that holds stb_rect_pack's code.
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_RECT_PACK_IMPLEMENTATION
#include <stb/stb_rect_pack.h>
