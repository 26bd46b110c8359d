// SPDX-License-Identifier: Apache-2.0
// The server behind treefarm serve against clients of all kinds. Without stored times: what is waited for has an end.
#include "serve/web_server.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "common/base/error.h"
#include "tests/support/plain_http.h"

namespace treefarm {
namespace {

SiteResponse echo(const SiteRequest& request) {
    SiteResponse response;
    response.body = request.method + " " + request.path;
    for (const auto& [name, value] : request.parameters)
        response.body += " " + name + "=" + value;
    if (request.path == "/large") response.body = std::string(32 << 20, 'x');
    if (request.path == "/throws") throw RunError("secret");
    if (request.method == "POST") response.status = 405;
    return response;
}

struct Running {
    explicit Running(const WebLimits& limits = {}) : server(&echo, limits), port(server.bind("127.0.0.1", 0)) {
        server.start();
    }
    WebServer server;
    int port;
};

TEST(WebServer, AnswersGetAndHead) {
    Running running;
    const test::HttpAnswer got = test::ask(running.port, "GET /status.json?run=a%2Fb%20c&x=1");
    EXPECT_EQ(got.status, 200);
    EXPECT_EQ(got.body, "GET /status.json run=a/b c x=1");
    const test::HttpAnswer head = test::ask(running.port, "HEAD /");
    EXPECT_EQ(head.status, 200);
    EXPECT_EQ(head.body, "");
    EXPECT_EQ(head.headers.at("Content-Length"), "6");
    EXPECT_EQ(test::ask(running.port, "POST /", "Content-Length: 5\r\n").status, 405);
    EXPECT_EQ(test::ask(running.port, "GET /large").body.size(), 32u << 20);
    const test::HttpAnswer failed = test::ask(running.port, "GET /throws");
    EXPECT_EQ(failed.status, 500);
    EXPECT_EQ(failed.body.find("secret"), std::string::npos);
}

TEST(WebServer, WhatIsNoRequestEndsNothing) {
    Running running;
    for (const std::string& bytes :
         {std::string("\r\n\r\n"), std::string("nonsense\r\n\r\n"), std::string("GET / HTTP/9.9\r\n\r\n"),
          std::string(100000, 'a'), std::string("GET /") + std::string(20000, 'a') + " HTTP/1.1\r\n\r\n",
          std::string(200, '\0'), std::string("GET /%zz HTTP/1.1\r\nHost: a\r\n\r\n")}) {
        test::Client client(running.port);
        client.send(bytes);
        client.receive(0.1);
    }
    EXPECT_EQ(test::ask(running.port, "GET /").status, 200);
}

TEST(WebServer, SlowClientsHurtNobody) {
    WebLimits limits;
    limits.threads = 1;
    limits.waiting = 16;
    limits.request_seconds = 0.5;
    Running running(limits);
    test::Client drip(running.port);
    std::atomic<bool> answered = false;
    std::thread dripping([&] {
        while (!answered) {  // a byte now and then would keep httplib's own time from running out
            drip.send("G");
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
    });
    std::vector<std::unique_ptr<test::Client>> silent;
    for (int k = 0; k < 3; ++k)
        silent.push_back(std::make_unique<test::Client>(running.port));
    EXPECT_EQ(test::ask(running.port, "GET /").status, 200) << "while one drips";
    answered = true;
    dripping.join();
}

TEST(WebServer, TooManyConnectionsAreSentAway) {
    WebLimits limits;
    limits.threads = 1;
    limits.waiting = 1;
    limits.request_seconds = 2;
    Running running(limits);
    std::vector<std::unique_ptr<test::Client>> silent;
    for (int k = 0; k < 8; ++k)
        silent.push_back(std::make_unique<test::Client>(running.port));
    // On a slow machine the last may come when the first have been given up.
    const auto sent_away = [](const auto& client) { return client->receive(20).starts_with("HTTP/1.1 503"); };
    EXPECT_TRUE(std::any_of(silent.rbegin(), silent.rend(), sent_away));
}

TEST(WebServer, ACrowdOfSilentClientsKeepsNoReaderOut) {
    WebLimits limits;
    limits.threads = 2;
    limits.waiting = 16;
    limits.request_seconds = 1000;
    Running running(limits);
    std::vector<std::unique_ptr<test::Client>> silent;
    for (int k = 0; k < 100; ++k) {
        silent.push_back(std::make_unique<test::Client>(running.port));
        if (k % 2) silent.back()->send("GET / HTTP/1.1\r\n");
    }
    EXPECT_EQ(test::ask(running.port, "GET /").status, 200) << "it would take 1000 seconds";
}

TEST(WebServer, ThoseWhoReadNothingKeepNoReaderOut) {
    WebLimits limits;
    limits.threads = 2;
    limits.request_seconds = 0.3;
    limits.response_seconds = 1000;
    Running running(limits);
    test::Client hungry(running.port), thirsty(running.port);
    for (test::Client* client : {&hungry, &thirsty})
        client->send("GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(test::ask(running.port, "GET /").status, 200);
}

TEST(WebServer, EndsWhateverClientsDo) {
    auto running = std::make_unique<Running>(WebLimits{4, 4, 1000, 1000, 32 << 10});
    test::Client silent(running->port), hungry(running->port);
    hungry.send("GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n");  // and never takes it
    EXPECT_EQ(test::ask(running->port, "GET /").status, 200);
    const int port = running->port;
    running.reset();  // would hang for 1000 seconds
    EXPECT_FALSE(test::Client(port).connected());
}

TEST(WebServer, APortInUseIsRefusedWithItsCure) {
    Running running;
    WebServer second(&echo);
    try {
        second.bind("127.0.0.1", running.port);
        FAIL() << "two servers share a port";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("in use"), std::string::npos) << error.what();
        EXPECT_NE(error.cure().find("--port"), std::string::npos);
    }
    EXPECT_THROW(second.bind("203.0.113.7", 0), InputError) << "no address of this machine";
}

}  // namespace
}  // namespace treefarm
