#include "app/console/console_main.h"

#include <QApplication>
#include <QIcon>
#include <QTimer>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stop_token>
#include <string>

#include "app/console/desktop/theme.h"
#include "app/console/main_window.h"
#include "core/error.h"
#include "core/system/file_sync.h"

namespace elbowroom::console {
namespace {

constexpr const char* kWhatToDo =
    "use --headless, or start a display server and set DISPLAY or WAYLAND_DISPLAY";

bool IsSet(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

// Without a display Qt would end the program with a core dump; this gives one line instead.
void RequireDisplay() {
  if (IsSet("DISPLAY") || IsSet("WAYLAND_DISPLAY") || IsSet("QT_QPA_PLATFORM")) return;
  throw core::Error(core::ErrorKind::kGraphics,
                    std::string("no display to open the window on: ") + kWhatToDo);
}

// Handles messages while Qt connects to the display: a fatal one becomes one line and exit status 1.
void ReportFatal(QtMsgType type, const QMessageLogContext& /*context*/, const QString& message) {
  if (type != QtFatalMsg) return;  // its warnings say what the fatal message repeats
  std::fprintf(stderr, "elbowroom: no display to open the window on: %s; %s\n",
               qUtf8Printable(message.simplified()), kWhatToDo);
  std::_Exit(EXIT_FAILURE);
}

// Nothing may be thrown through Qt's event loop: an exception of a slot is shown, and the console goes on.
class ConsoleApplication : public QApplication {
 public:
  using QApplication::QApplication;

  void ShowErrorsIn(MainWindow* window) { window_ = window; }

  bool notify(QObject* receiver, QEvent* event) override {
    try {
      return QApplication::notify(receiver, event);
    } catch (const std::exception& error) {
      if (window_ == nullptr) throw;
      window_->ShowError(QString::fromUtf8(error.what()));
      return true;
    }
  }

 private:
  MainWindow* window_ = nullptr;
};

void StartWhatWasAsked(MainWindow& window, const ConsoleOptions& options) {
  if (!options.trial_file.empty()) {
    window.OpenFile(QString::fromStdString(options.trial_file.string()));
  } else if (options.demo) {
    StartDemo(window.desk(), window.session_place());
  }
}

void CloseInOrder(MainWindow& window) {
  if (QWidget* dialog = QApplication::activeModalWidget()) dialog->close();
  window.layout_page().desk().Keep();  // nobody is there to ask
  window.procedure().SaveAnswers();
  window.close();
}

}  // namespace

int RunConsole(const ConsoleOptions& options) {
  RequireDisplay();
  if (options.demo) core::MakeFolder(core::FolderOf(options.session));
  std::string program = "elbowroom";
  char* default_argv[] = {program.data(), nullptr};
  int argc = options.argv != nullptr ? options.argc : 1;
  const QtMessageHandler usual = qInstallMessageHandler(ReportFatal);
  ConsoleApplication application(argc, options.argv != nullptr ? options.argv : default_argv);
  qInstallMessageHandler(usual);
  QApplication::setOrganizationName("Elbowroom");  // of the settings
  QApplication::setApplicationName("Elbowroom");
  QApplication::setDesktopFileName("elbowroom");  // of app/desktop
  QApplication::setWindowIcon(QIcon::fromTheme("elbowroom"));
  // A picture for the documentation doesn't depend on what its maker likes.
  SetTheme(options.picture ? Theme::kLight : RememberedTheme());

  MainWindow window(options.session);
  if (!options.picture) window.Remember();
  application.ShowErrorsIn(&window);
  std::string picture_error;
  if (options.picture) {
    auto* picture = new WindowPicture(*options.picture, window);
    QObject::connect(picture, &WindowPicture::Taken, &window, [&](const QString& error) {
      picture_error = error.toStdString();
      window.close();
    });
  }
  window.show();
  QTimer::singleShot(0, &window, [&] { StartWhatWasAsked(window, options); });
  // Ctrl-C, or the end of the user's login, closes the window as its button does: the trial ends in order.
  const std::stop_callback close_on_stop(options.stop, [&window] {
    QMetaObject::invokeMethod(
        &window, [&window] { CloseInOrder(window); }, Qt::QueuedConnection);
  });
  const int status = QApplication::exec();
  application.ShowErrorsIn(nullptr);
  if (!picture_error.empty()) throw core::Error(core::ErrorKind::kFile, picture_error);
  return status;
}

}  // namespace elbowroom::console
