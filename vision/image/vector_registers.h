// SPDX-License-Identifier: Apache-2.0
// Whether plain loops over bytes vectorise on the processor that this is compiled for. Where they do not, the same
// results come from arithmetic on parts of words (H. S. Warren, "Hacker's Delight", 2nd ed., section 2-18).
#pragma once

namespace touchline {

#if defined(__SSE2__) || defined(__ARM_NEON)
inline constexpr bool vector_registers = true;
#else
inline constexpr bool vector_registers = false;
#endif

}  // namespace touchline
