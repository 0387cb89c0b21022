// The console's few colours.
#pragma once

#include <QColor>

namespace elbowroom::console {

inline constexpr QColor kViewBackground(0xdf, 0xe4, 0xea);
inline constexpr QColor kQuietText(0x5b, 0x66, 0x73);
inline constexpr QColor kContactRed(0xb4, 0x2f, 0x16);
inline constexpr QColor kContactTint(0xfc, 0xe9, 0xe4);
inline constexpr QColor kClearGreen(0x2c, 0x7a, 0x45);
inline constexpr QColor kAttentionAmber(0x8a, 0x5a, 0x00);
inline constexpr QColor kSilhouetteObject(0xf4, 0xf6, 0xf8);
inline constexpr QColor kSilhouetteBackground(0x24, 0x2b, 0x33);

}  // namespace elbowroom::console
