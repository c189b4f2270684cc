#include "app/watch_requests.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>

#include "evaluation/results/json_text.hpp"
#include "report/page.hpp"
#include "report/page_text.hpp"
#include "sources/text_lines.hpp"

namespace glocal::app {
namespace {

const httplib::Headers& headers() {
  static const httplib::Headers all = {
      {"Cache-Control", "no-store"},
      {"Content-Security-Policy",
       "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
       "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"}};
  return all;
}

std::optional<std::uint64_t> version_of(const httplib::Request& request) {
  return whole_number_in(request.get_param_value("version"));
}

/// The status.
int answer(const httplib::Request& request, httplib::Response& response, LiveRun& run, int port) {
  // Other names may have been made to point here by a page from elsewhere.
  const std::string host = request.get_header_value("Host");
  if (host != fmt::format("{}:{}", watch_address, port) && host != fmt::format("localhost:{}", port))
    return 403;
  if (request.path != "/" && request.path != "/data") return 404;
  if (request.method != "GET") {
    response.set_header("Allow", "GET");
    return 405;
  }
  const bool is_page = request.path == "/";
  const auto news = run.news(is_page ? std::nullopt : version_of(request));
  if (!news) return 204;
  if (is_page) {
    response.set_content(page_with(page_text, news->data["runs"][0]["name"], {news->data}),
                         "text/html; charset=utf-8");
  } else {
    response.set_content(json_text(news->data), "application/json");
  }
  run.told(news->version);
  return 200;
}

}  // namespace

void answer_watchers(httplib::Server& server, LiveRun& run, int port) {
  server.set_default_headers(headers());
  server.set_pre_routing_handler([&run, port](const httplib::Request& request, httplib::Response& response) {
    response.status = answer(request, response, run, port);
    return httplib::Server::HandlerResponse::Handled;
  });
}

}  // namespace glocal::app
