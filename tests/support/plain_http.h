// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace treefarm::test {

/// A connection to a port of this machine, as a client that may do anything with it.
class Client {
  public:
    explicit Client(int port);
    ~Client();
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    bool connected() const { return connected_; }
    void send(const std::string& bytes);
    /// Everything until the other side closes, for up to so many seconds.
    std::string receive(double seconds);

  private:
    int socket_;
    bool connected_ = false;
};

/// A response, taken apart strictly.
struct HttpAnswer {
    int status = 0;  ///< 0: it was no response
    std::map<std::string, std::string> headers;
    std::string body;
};
HttpAnswer parse_answer(const std::string& bytes);

/// Sends one request ("GET /metrics") with more header lines ("Cookie: a=b\r\n") and takes its response.
HttpAnswer ask(int port, const std::string& request, const std::string& headers = "");

}  // namespace treefarm::test
