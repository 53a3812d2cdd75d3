#define SIGNORINI_KERNELS kernels_fma
#include <signorini/lcp/sweep_kernels_body.h>
