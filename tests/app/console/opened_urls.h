// What the program asks the desktop to open, kept instead of opened.
#pragma once

#include <QDesktopServices>
#include <QObject>
#include <QUrl>
#include <vector>

namespace elbowroom::console {

class OpenedUrls : public QObject {
  Q_OBJECT

 public:
  OpenedUrls() { QDesktopServices::setUrlHandler("file", this, "Open"); }
  ~OpenedUrls() override { QDesktopServices::unsetUrlHandler("file"); }

  [[nodiscard]] const std::vector<QUrl>& urls() const { return urls_; }

 public slots:
  void Open(const QUrl& url) { urls_.push_back(url); }

 private:
  std::vector<QUrl> urls_;
};

}  // namespace elbowroom::console
