#include "app/console/reviews/review_start.h"

#include <QDir>
#include <QFileInfo>
#include <QLabel>
#include <QStyle>

#include "app/console/reviews/recent_sessions.h"

namespace elbowroom::console {
namespace {

constexpr int kColumnWidthPx = 420;
constexpr int kMostListed = 5;

}  // namespace

ReviewStart::ReviewStart(QWidget* parent) : QWidget(parent) {
  auto* column = new QWidget;
  column->setMaximumWidth(kColumnWidthPx);
  column_ = new QVBoxLayout(column);
  auto* title = new QLabel(tr("Review a session"));
  QFont font = title->font();
  font.setPointSizeF(1.8 * font.pointSizeF());
  title->setFont(font);
  auto* open = new QPushButton(style()->standardIcon(QStyle::SP_DialogOpenButton), tr("&Open session …"));
  open->setObjectName("review_open");
  open->setMinimumHeight(2 * fontMetrics().height());
  open->setToolTip(tr("Open a session (.db) that a trial or a replay recorded"));
  connect(open, &QPushButton::clicked, this, &ReviewStart::OpenAsked);
  auto* hint =
      new QLabel(tr("What was touched, when, how deep; and what it would have been with another gap. "
                    "A session can be dropped here, too."));
  hint->setWordWrap(true);
  hint->setForegroundRole(QPalette::PlaceholderText);
  column_->addWidget(title);
  column_->addSpacing(10);
  column_->addWidget(open);
  column_->addWidget(hint);
  auto* centred = new QHBoxLayout;
  centred->addStretch(1);
  centred->addWidget(column, 4);
  centred->addStretch(1);
  auto* page = new QVBoxLayout(this);
  page->addStretch(1);
  page->addLayout(centred);
  page->addStretch(2);
}

void ReviewStart::showEvent(QShowEvent* event) {
  ListRecent();
  QWidget::showEvent(event);
}

void ReviewStart::ListRecent() {
  delete recent_;
  recent_ = new QWidget;
  auto* list = new QVBoxLayout(recent_);
  list->setContentsMargins(0, 14, 0, 0);
  const QStringList sessions = RecentSessions().mid(0, kMostListed);
  if (!sessions.isEmpty()) list->addWidget(new QLabel(tr("Opened last")));
  for (const QString& file : sessions) {
    auto* link = new QPushButton(QFileInfo(file).fileName());
    link->setFlat(true);
    link->setStyleSheet("text-align: left;");
    link->setToolTip(QDir::toNativeSeparators(file));
    connect(link, &QPushButton::clicked, this, [this, file] { emit Chosen(file); });
    list->addWidget(link);
  }
  column_->addWidget(recent_);
}

}  // namespace elbowroom::console
