// A way through the pages and dialogs of the window, on which each is looked at.
#pragma once

#include <QSet>
#include <QString>
#include <QStringList>
#include <QWidget>
#include <optional>
#include <string>

#include "tests/app/console/looks/untranslated.h"
#include "tests/app/console/window_fixture.h"

namespace elbowroom::console {

// What is asked of each page: that all of it can be read, or that all of its texts can be translated.
enum class Inspection { kFit, kWords };

// In place before the window is made: most of what it says is written then.
class TourLanguage : public testing::WithParamInterface<Inspection> {
 protected:
  TourLanguage();
  ~TourLanguage();

 private:
  std::optional<AccentTranslator> translator_;
};

// ELBOWROOM_SCREENSHOTS names a folder that keeps a picture of each page that is looked at for kFit;
// ELBOWROOM_SCREENSHOTS_SIZE gives the window's size (1280x720), ELBOWROOM_SCREENSHOTS_DARK dark colours.
class Tour : public TourLanguage, public WindowFixture {
 protected:
  explicit Tour(const std::string& session = "trial.db");

  // The page that the window shows; or a dialog.
  void Look(const char* name) { Look(name, window_); }
  void Look(const char* name, QWidget& top);
  // What isn't the window's to translate: names of parts, files, participants.
  void Know(const QStringList& names);

  QSet<QString> known_;
};

inline std::string InspectionName(const testing::TestParamInfo<Inspection>& info) {
  return info.param == Inspection::kFit ? "CanBeRead" : "CanBeTranslated";
}

}  // namespace elbowroom::console
