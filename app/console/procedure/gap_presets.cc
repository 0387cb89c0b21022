#include "app/console/procedure/gap_presets.h"

#include <QCryptographicHash>
#include <QSettings>
#include <QVariantList>
#include <cmath>

namespace elbowroom::console {
namespace {

constexpr std::size_t kMostPresets = 100;

// The names' hash: they may hold any sign, a settings' key may not.
QString GroupOf(const std::vector<std::string>& spacings) {
  QCryptographicHash hash(QCryptographicHash::Sha1);
  for (const std::string& name : spacings) {
    hash.addData(QByteArray::fromStdString(name));
    hash.addData(QByteArray(1, '\0'));
  }
  return "gap_presets/" + QString::fromLatin1(hash.result().toHex().left(16));
}

}  // namespace

std::vector<GapPreset> PresetsFor(const std::vector<std::string>& spacings) {
  QSettings settings;
  std::vector<GapPreset> presets;
  const int count = settings.beginReadArray(GroupOf(spacings));
  for (int i = 0; i < count && presets.size() < kMostPresets; ++i) {
    settings.setArrayIndex(i);
    GapPreset preset{settings.value("name").toString(), {}};
    for (const QVariant& gap : settings.value("gap_mm").toList()) {
      bool is_number = false;
      const double gap_mm = gap.toDouble(&is_number);
      if (is_number && std::isfinite(gap_mm)) preset.gap_mm.push_back(gap_mm);
    }
    if (!preset.name.isEmpty() && preset.gap_mm.size() == spacings.size()) presets.push_back(preset);
  }
  settings.endArray();
  return presets;
}

void KeepPresets(const std::vector<std::string>& spacings, const std::vector<GapPreset>& presets) {
  QSettings settings;
  settings.remove(GroupOf(spacings));
  settings.beginWriteArray(GroupOf(spacings), static_cast<int>(presets.size()));
  for (std::size_t i = 0; i < presets.size(); ++i) {
    settings.setArrayIndex(static_cast<int>(i));
    settings.setValue("name", presets[i].name);
    QVariantList gaps;
    for (const double gap_mm : presets[i].gap_mm) gaps << gap_mm;
    settings.setValue("gap_mm", gaps);
  }
  settings.endArray();
}

}  // namespace elbowroom::console
