#include "tests/app/console/looks/tour.h"

#include <QApplication>
#include <QDateTime>
#include <QLocale>
#include <QRegularExpression>
#include <QSettings>

#include "app/console/desktop/theme.h"
#include "tests/app/console/looks/fit_check.h"
#include "tests/app/console/looks/kept_picture.h"

namespace elbowroom::console {
namespace {

// Units, axes, keys, kinds of files, and names that are the same in every language.
const QSet<QString>& WordsOfAllLanguages() {
  static const QSet<QString> words = {
      "mm",    "cm",        "m",         "s",        "ms",  "px",   "hz",  "x",      "y",
      "z",     "g",         "utc",       "udp",      "bcf", "toml", "yml", "trial",  "layout",
      "rig",   "calib",     "head",      "db",       "stl", "ply",  "glb", "bcfzip", "opentrack",
      "freed", "elbowroom", "offscreen", "llvmpipe", "cad", "id",   "in"};
  return words;
}

// What the rooms below the window say, in English: findings of the preflight, errors, progress. And what
// changes with each machine.
const QSet<QString>& EnglishWidgets() {
  static const QSet<QString> names = {"preflight_rows", "calibration_advice", "import_warnings",
                                      "status_progress", "status_driver"};
  return names;
}

}  // namespace

TourLanguage::TourLanguage() {
  QSettings().clear();  // what another tour left open or closed
  SetTheme(qEnvironmentVariableIsSet("ELBOWROOM_SCREENSHOTS_DARK") ? Theme::kDark : Theme::kLight);
  if (GetParam() != Inspection::kWords) return;
  translator_.emplace();
  QCoreApplication::installTranslator(&*translator_);
}

TourLanguage::~TourLanguage() {
  if (translator_) QCoreApplication::removeTranslator(&*translator_);
}

Tour::Tour(const std::string& session) : WindowFixture(session, WantedSize()), known_(WordsOfAllLanguages()) {
  Know({QString::fromStdString(folder_.path().string()),
        QLocale().toString(QDateTime::currentDateTime(), QLocale::ShortFormat)});
}

void Tour::Know(const QStringList& names) {
  static const QRegularExpression no_letters("[^A-Za-z]+");
  for (const QString& name : names)
    for (const QString& word : name.split(no_letters, Qt::SkipEmptyParts)) known_.insert(word.toLower());
}

void Tour::Look(const char* name, QWidget& top) {
  SCOPED_TRACE(name);
  AwaitLayout();
  if (GetParam() == Inspection::kWords) {
    for (const QString& line : UntranslatedTexts(top, known_, EnglishWidgets()))
      ADD_FAILURE() << "not translated: " << line.toStdString();
    return;
  }
  EXPECT_TRUE(&top != &window_ || top.size() == WantedSize())
      << "something needs more: " << top.width() << " x " << top.height();
  EXPECT_TRUE(top.isFullScreen() ||
              (top.width() <= WantedSize().width() && top.height() <= WantedSize().height()))
      << top.width() << " x " << top.height();
  for (const QString& line : FaultsOfFit(top)) ADD_FAILURE() << line.toStdString();
  KeepPicture(name, top);
}

}  // namespace elbowroom::console
