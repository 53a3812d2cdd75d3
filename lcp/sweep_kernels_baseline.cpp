#define SIGNORINI_KERNELS kernels_baseline
#include <signorini/lcp/sweep_kernels_body.h>
