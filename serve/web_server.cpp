// SPDX-License-Identifier: Apache-2.0
#include "serve/web_server.h"

#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <thread>
#include <utility>

#include "common/base/error.h"
#include "serve/pending_requests.h"
#include "serve/timed_stream.h"

namespace treefarm {

namespace {

/// Runs each task in the accepting thread: it only passes the connection on.
class NoQueue final : public httplib::TaskQueue {
  public:
    void enqueue(std::function<void()> task) override { task(); }
    void shutdown() override {}
};

SiteRequest site_request(const httplib::Request& request) {
    SiteRequest asked;
    asked.method = request.method;
    asked.path = request.path;
    for (const auto& [name, value] : request.params)
        asked.parameters.try_emplace(name, value);
    asked.host = request.get_header_value("Host");
    asked.authorization = request.get_header_value("Authorization");
    asked.cookie = request.get_header_value("Cookie");
    asked.if_none_match = request.get_header_value("If-None-Match");
    return asked;
}

void fill(httplib::Response& to, const SiteResponse& response) {
    to.status = response.status;
    for (const auto& [name, value] : response.headers)
        to.set_header(name, value);
    if (response.status != 304) to.set_content(response.body, response.type);
}

std::string host_and_port(const std::string& address, int port) {
    return (address.find(':') == std::string::npos ? address : "[" + address + "]") + ":" + std::to_string(port);
}

}  // namespace

class WebServer::Server final : public httplib::Server {
  public:
    Server(Respond respond, const WebLimits& limits) : respond_(std::move(respond)), limits_(limits) {
        new_task_queue = [] { return new NoQueue; };
        // By default httplib shares a port with another process.
        set_socket_options([](socket_t socket) {
            const int yes = 1;
            setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
            fill(response, respond_(site_request(request)));
            return HandlerResponse::Handled;
        });
        set_exception_handler([](const httplib::Request&, httplib::Response& response, const std::exception_ptr&) {
            response.status = 500;
            response.set_content("something went wrong\n", "text/plain");
        });
    }
    ~Server() override { end(); }

    void begin() {
        ::listen(svr_sock_, SOMAXCONN);  // httplib lets five wait, and others knock again after a second or more
        pending_ = std::make_unique<PendingRequests>(limits_, [this](int socket) { answer(socket); });
        thread_ = std::thread([this] {
            listen_after_bind();
            ended_ = true;
        });
        while (!is_running() && !ended_)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

    void end() {
        stopping_ = true;
        if (!thread_.joinable()) return;
        httplib::Server::stop();
        thread_.join();
        pending_.reset();
    }

  private:
    bool process_and_close_socket(socket_t socket) override {
        pending_->add(socket);
        return true;
    }

    void answer(int socket) {
        TimedStream stream(socket, limits_, stopping_, [this] { return pending_->waits(); });
        bool closed = false;
        process_request(stream, true, closed, [](httplib::Request& request) {
            request.headers.erase(
                "Accept-Encoding");  // compressing what is requested each second would cost more than it saves
            request.headers.erase("Range");
            request.ranges.clear();
        });
        stream.end();
        ::close(socket);
    }

    const Respond respond_;
    const WebLimits limits_;
    std::atomic<bool> stopping_ = false, ended_ = false;
    std::unique_ptr<PendingRequests> pending_;
    std::thread thread_;
};

WebServer::WebServer(Respond respond, const WebLimits& limits)
    : server_(std::make_unique<Server>(std::move(respond), limits)) {}

WebServer::~WebServer() = default;

int WebServer::bind(const std::string& address, int port) {
    errno = 0;
    const int got = port == 0 ? server_->bind_to_any_port(address) : (server_->bind_to_port(address, port) ? port : -1);
    const int code = errno;
    if (got > 0) return got;
    const Location where{host_and_port(address, port), 0, 0};
    if (code == EADDRINUSE)
        throw InputError(where, "the port is in use", "name another with --port, or --port 0 for any that is free");
    if (code == EACCES) throw InputError(where, "this port is the system's", "name one above 1023 with --port");
    throw InputError(where, std::string("cannot be listened at: ") + (code ? std::strerror(code) : "no such address"),
                     "name an address of this machine with --address, 0.0.0.0 for all of them");
}

void WebServer::start() {
    server_->begin();
}

void WebServer::stop() {
    server_->end();
}

}  // namespace treefarm
