#define SIGNORINI_KERNELS kernels_avx2
#include <signorini/lcp/sweep_kernels_body.h>
