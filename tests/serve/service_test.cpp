// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/service.hpp"

#include "base/float_bits.hpp"
#include "mesh/append_mesh.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/tooth_file.hpp"
#include "service_fixture.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>
#include <zip.h>

#include <array>
#include <cctype>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

namespace rhizodont::test {
namespace {

namespace fs = std::filesystem;

TEST_F(ServiceTest, SaysWhatItIsAndEveryRouteIsDescribed) {
  const Json about = json_of(get("/api/v1/about"), 200);
  EXPECT_EQ(about["program"]["name"], "rhizodont");
  EXPECT_NE(std::string(about["notice"]).find("not the patient's anatomy"), std::string::npos);
  const Json described = json_of(get("/api/v1/openapi.json"), 200);
  std::size_t operations = 0;
  for (const auto& [path, methods] : described["paths"].items()) operations += methods.size();
  EXPECT_EQ(operations, serve::service_routes().size());
  for (auto [method, path] : serve::service_routes()) {
    for (char& c : method) c = static_cast<char>(std::tolower(c));
    EXPECT_TRUE(described["paths"].contains(path) && described["paths"][path].contains(method))
        << method << " " << path;
  }
}

TEST_F(ServiceTest, SamplesAreThoseOfTheProject) {
  const Json list = json_of(get("/api/v1/samples"), 200)["samples"];
  EXPECT_EQ(list.size(), 7U);
  for (const Json& sample : list) {
    const std::string name = sample["name"];
    const auto file = get("/api/v1/samples/" + name);
    ASSERT_TRUE(file);
    EXPECT_EQ(file->body, sample_bytes(name)) << name;
    EXPECT_EQ(sample["kind"], name == "scan_lower.ply" ? "arch" : "tooth") << name;
  }
  expect_refusal(get("/api/v1/samples/none.ply"), 404, "nothing at this address");
}

TEST_F(ServiceTest, ToothIsTheLibrarysToTheByteInEveryFormat) {
  const std::string job = start_sample("crown_36.stl", {{"e_mm", 1}});
  const Json done = ended(job);
  ASSERT_EQ(done["state"], "done") << done.dump(1);
  EXPECT_EQ(done["tooth"]["fdi"], 36);
  EXPECT_TRUE(done["tooth"]["crown_holds"]);
  EXPECT_TRUE(done["tooth"]["interval"].is_object());

  const MeshFile crown = load_mesh(fs::path(RHIZODONT_SOURCE_DIR) / "samples/crown_36.stl");
  CompleteOptions options;
  options.fdi = 36;
  options.e = 1;
  const CompletedTooth tooth = complete_tooth(crown.mesh, CompletionModels::load(default_models_folder()), options);
  for (const char* name : {"tooth.ply", "tooth.stl", "tooth.obj", "tooth.glb"}) {
    const auto file = get("/api/v1/jobs/" + job + "/files/" + name);
    ASSERT_TRUE(file && file->status == 200) << name;
    EXPECT_TRUE(file->body == mesh_file_bytes(name, tooth_file(tooth, crown))) << name;
    EXPECT_EQ(file->get_header_value("Content-Disposition"),
              "attachment; filename=\"tooth_36" + fs::path(name).extension().string() + "\"");
  }
  const Json report = json_of(get("/api/v1/jobs/" + job + "/files/report.json"), 200);
  EXPECT_EQ(report["report_version"], 3);
  EXPECT_TRUE(report["input"]["file"].is_null());
  EXPECT_EQ(report["warnings"][0], "Tooth 36, taken from the file's name.");
  const auto page = get("/api/v1/jobs/" + job + "/files/report.html");
  EXPECT_EQ(page->status == 200, get("/")->body.find("without its page") == std::string::npos);
  expect_refusal(get("/api/v1/jobs/" + job + "/files/tooth.exe"), 404, "nothing at this address");
}

TEST_F(ServiceTest, ZipHoldsEverything) {
  const std::string job = start_sample("crown_34.ply", {{"e_mm", 1}});
  ASSERT_EQ(ended(job)["state"], "done");
  const auto archive = get("/api/v1/jobs/" + job + "/files/all.zip");
  ASSERT_TRUE(archive && archive->status == 200);
  zip_error_t error;
  zip_source_t* source = zip_source_buffer_create(archive->body.data(), archive->body.size(), 0, &error);
  zip_t* opened = zip_open_from_source(source, ZIP_RDONLY, &error);
  ASSERT_NE(opened, nullptr);
  EXPECT_EQ(zip_get_num_entries(opened, 0), 5);
  for (const char* name : {"tooth.ply", "tooth.stl", "tooth.obj", "tooth.glb", "report.json"})
    EXPECT_GE(zip_name_locate(opened, name, 0), 0) << name;
  zip_close(opened);
  EXPECT_EQ(get("/api/v1/jobs/" + job + "/files/all.zip")->body, archive->body) << "equal files, equal bytes";
}

TEST_F(ServiceTest, StagesComeAsTheyHappenAndCanBeTakenUpAgain) {
  const std::string job = start_sample("crown_23.ply", {{"e_mm", 1}});
  const std::string text = events(job);
  std::size_t at = 0;
  for (const char* words : {"event: state", "crown", "frame", "completion network", "guiding surface", "joining",
                            "check", "event: end\ndata: {\"state\":\"done\"}"}) {
    const std::size_t found = text.find(words, at);
    ASSERT_NE(found, std::string::npos) << words << " is missing, or out of order:\n" << text;
    at = found;
  }
  EXPECT_NE(text.find("id: 0\n"), std::string::npos);
  const std::string rest = events(job, {{"Last-Event-ID", "2"}});
  EXPECT_EQ(rest.find("id: 2\n"), std::string::npos);
  EXPECT_NE(rest.find("id: 3\n"), std::string::npos);
}

TEST_F(ServiceTest, SteeringRunsTheSecondHalfAloneAndKeepsWhatCannotBe) {
  const std::string job = start_sample("crown_36.stl", {{"e_mm", 1}});
  ASSERT_EQ(ended(job)["state"], "done");
  const std::string path = "/api/v1/jobs/" + job + "/steering";
  const Json longer = json_of(post(path, "{\"root_length_mm\": 17.5, \"tip_degrees\": 3}"), 200);
  EXPECT_NEAR(longer["tooth"]["root_length_mm"].get<double>(), 17.5, 0.35);
  EXPECT_EQ(longer["revision"], 1);
  const std::string steered = get("/api/v1/jobs/" + job + "/files/tooth.ply")->body;
  expect_refusal(post(path, "{\"root_length_mm\": 99}"), 400, "root");
  expect_refusal(post(path, "{\"root_length_mm\": \"long\"}"), 400, "root_length_mm");
  expect_refusal(post(path, "{\"colour\": 1}"), 400, "colour");
  EXPECT_EQ(get("/api/v1/jobs/" + job + "/files/tooth.ply")->body, steered);
  json_of(post(path, "{}"), 200);
  EXPECT_NE(get("/api/v1/jobs/" + job + "/files/tooth.ply")->body, steered);

  // as one call would have made it
  const Json options{{"e_mm", 1}, {"steering", {{"root_length_mm", 17.5}, {"tip_degrees", 3}}}};
  const std::string at_once = start_sample("crown_36.stl", options);
  ASSERT_EQ(ended(at_once)["state"], "done");
  EXPECT_TRUE(get("/api/v1/jobs/" + at_once + "/files/tooth.ply")->body == steered);
}

/// The header of a view and its arrays by name.
Json header_of(const std::string& view) {
  std::uint32_t size = 0;
  std::memcpy(&size, view.data() + 4, 4);
  return Json::parse(view.substr(8, size));
}

TEST_F(ServiceTest, ViewsHaveTheirNumbers) {
  const std::string job = start_sample("skirt_36.ply", {{"e_mm", 1}, {"skirt", "auto"}});
  const Json done = ended(job);
  ASSERT_EQ(done["state"], "done") << done.dump(1);
  const auto names = [&](const std::string& view) {
    const auto answer = get("/api/v1/jobs/" + job + "/views/" + view);
    EXPECT_TRUE(answer && answer->status == 200) << view;
    EXPECT_EQ(answer->body.substr(0, 4), "RZV1");
    std::string all;
    const Json header = header_of(answer->body);
    for (const Json& array : header["arrays"]) all += std::string(array["name"]) + " ";
    return all;
  };
  EXPECT_EQ(names("tooth"), "position index source uncertainty quality ");
  EXPECT_EQ(names("crown"), "position index confidence deviation kept quality ");
  EXPECT_EQ(names("shortest"), "position index source uncertainty quality ");
  EXPECT_EQ(names("longest"), "position index source uncertainty quality ");
  expect_refusal(get("/api/v1/jobs/" + job + "/views/gum"), 404, "nothing");
}

TEST_F(ServiceTest, CrownsThatCannotBeUsedAreRefusedInTheCommandLinesWords) {
  expect_refusal(post("/api/v1/scans?name=x.ply", "no mesh", "application/octet-stream"), 422, "");
  MeshFile flat;
  flat.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  flat.mesh.triangles = {{0, 1, 2}};
  const std::string job = start({{"scan", send(mesh_file_bytes("x.ply", flat), "x.ply")}, {"options", {{"fdi", 36}}}});
  const Json refused = ended(job);
  EXPECT_EQ(refused["state"], "refused");
  std::string sentence;
  try {
    CompleteOptions options;
    options.fdi = 36;
    complete_tooth(flat.mesh, CompletionModels::load(default_models_folder()), options);
  } catch (const Error& error) {
    sentence = error.what();
  }
  EXPECT_EQ(refused["error"]["sentence"], sentence);
  EXPECT_EQ(refused["error"]["exit_code"], 3);
  expect_refusal(get("/api/v1/jobs/" + job + "/files/tooth.ply"), 409, "no result");
  expect_refusal(post("/api/v1/jobs/" + job + "/steering", "{}"), 409, "no tooth yet");
}

TEST_F(ServiceTest, RequestsThatAreNoneAreRefused) {
  const std::string scan = send(sample_bytes("crown_34.ply"), "crown_34.ply");
  const auto job = [&](const std::string& body) { return post("/api/v1/jobs", body); };
  expect_refusal(job("{"), 400, "no JSON");
  expect_refusal(job("[]"), 400, "must be a JSON object");
  expect_refusal(job("{}"), 400, "needs a scan");
  expect_refusal(job("{\"scan\": \"00000000000000000000000000000000\"}"), 404, "no such scan");
  expect_refusal(job("{\"scan\": 4}"), 400, "scan");
  expect_refusal(job("{\"scan\": \"" + scan + "\", \"kind\": \"jaw\"}"), 400, "tooth or arch");
  expect_refusal(job("{\"scan\": \"" + scan + "\", \"options\": {\"fdi\": 3.5}}"), 400, "fdi");
  expect_refusal(job("{\"scan\": \"" + scan + "\", \"clearance_mm\": 1}"), 400, "clearance_mm");
  expect_refusal(job(std::string(3000, '[')), 400, "");
  expect_refusal(job("{\"scan\": \"" + std::string(20000, 'a') + "\"}"), 413, "larger");
  expect_refusal(post("/api/v1/jobs", "{}", "text/plain"), 415, "application/json");
  expect_refusal(post("/api/v1/scans", "x", "text/plain"), 415, "octet-stream");
  for (const char* path :
       {"/api/v1/jobs/00000000000000000000000000000000", "/api/v1/jobs/..", "/api/v1/jobs/%2e%2e%2f", "/api/v2/about",
        "/../../etc/passwd", "/samples/crown_36.stl", "/api/v1/samples/../index.html"})
    expect_refusal(get(path), 404, "");
  // out of its range: said when it is used, as by the command line
  EXPECT_EQ(ended(start({{"scan", scan}, {"options", {{"e_mm", 9}}}}))["error"]["exit_code"], 2);
}

TEST_F(ServiceTest, OtherHostsAndOriginsAreRefused) {
  for (const char* host : {"evil.example", "evil.example:80", "127.0.0.1.evil.example", "localhost.evil.example", ""})
    expect_refusal(get("/api/v1/about", {{"Host", host}}), 403, "127.0.0.1");
  const std::string own = "127.0.0.1:" + std::to_string(service.port());
  expect_refusal(get("/api/v1/about", {{"Origin", "http://evil.example"}}), 403, "Other pages");
  expect_refusal(get("/api/v1/about", {{"Origin", "null"}}), 403, "Other pages");
  expect_refusal(get("/", {{"Host", "evil.example"}}), 403, "127.0.0.1");
  expect_refusal(get("/api/v1/about", {{"Sec-Fetch-Site", "cross-site"}}), 403, "Other pages");
  EXPECT_EQ(get("/api/v1/about", {{"Host", own}, {"Origin", "http://" + own}})->status, 200);
  EXPECT_EQ(get("/api/v1/about", {{"Host", "localhost:9"}, {"Origin", "http://localhost:9"}})->status, 200)
      << "forwarded";
  const auto page = get("/");
  EXPECT_EQ(page->status, 200);
  EXPECT_NE(page->get_header_value("Content-Security-Policy").find("default-src 'none'"), std::string::npos);
  EXPECT_FALSE(page->has_header("Access-Control-Allow-Origin"));
}

TEST_F(ServiceTest, ListensOnThisMachineAlone) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(service.port()));
  address.sin_addr.s_addr = htonl(0x7F000002);  // 127.0.0.2: another address of this machine
  EXPECT_NE(connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  close(socket);
  serve::Service second(CompletionModels::load(default_models_folder()));
  EXPECT_THROW(second.bind(service.port()), UsageError);
}

TEST_F(ServiceTest, JobsAreCancelledAndForgotten) {
  const std::string job = start_sample("crown_36.stl", {{"e_mm", 0.2}});
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  json_of(post("/api/v1/jobs/" + job + "/cancel", ""), 202);
  const Json cancelled = ended(job);
  EXPECT_EQ(cancelled["state"], "cancelled");
  EXPECT_FALSE(cancelled.contains("tooth"));
  EXPECT_EQ(service.client()->Delete("/api/v1/jobs/" + job)->status, 204);
  expect_refusal(get("/api/v1/jobs/" + job), 404, "no such job");
}

TEST_F(ServiceTest, TwoClientsDoNotDisturbEachOther) {
  std::array<std::string, 2> teeth;
  std::vector<std::thread> clients;
  const std::array<const char*, 2> names{"crown_23.ply", "crown_34.ply"};
  for (std::size_t i = 0; i < 2; ++i)
    clients.emplace_back([&, i] {
      const std::string job = start_sample(names[i], {{"e_mm", 1}});
      ended(job);
      teeth[i] = get("/api/v1/jobs/" + job + "/files/tooth.ply")->body;
    });
  for (std::thread& client : clients) client.join();
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string alone = start_sample(names[i], {{"e_mm", 1}});
    ended(alone);
    EXPECT_TRUE(get("/api/v1/jobs/" + alone + "/files/tooth.ply")->body == teeth[i]) << names[i];
  }
}

TEST_F(ServiceTest, ClientThatGoesAwayLeavesTheJobForTheNext) {
  const std::string job = start_sample("crown_23.ply", {{"e_mm", 1}});
  service.client()->Get("/api/v1/jobs/" + job + "/events", [](const char*, std::size_t) { return false; });
  EXPECT_EQ(ended(job)["state"], "done");
  EXPECT_EQ(get("/metrics")->status, 200);
}

TEST_F(ServiceTest, MetricsCountAndTheLogNamesNobody) {
  const std::string job =
      start({{"scan", send(sample_bytes("crown_34.ply"), "Mustermann_Max_34.ply")}, {"options", {{"e_mm", 1}}}});
  ended(job);
  // A job is counted when its worker is done with it, a moment after it says that it has ended.
  std::string metrics;
  for (int tries = 0; tries < 200 && metrics.find("outcome=\"done\"") == std::string::npos; ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
    metrics = get("/metrics")->body;
  }
  for (const char* line : {"rhizodont_requests_total{route=\"/api/v1/scans\",status=\"201\"} 1",
                           "rhizodont_jobs_total{kind=\"tooth\",outcome=\"done\"} 1", "rhizodont_jobs_kept 1",
                           "rhizodont_resident_bytes "})
    EXPECT_NE(metrics.find(line), std::string::npos) << line << "\n" << metrics;
  const std::string log = service.log();
  EXPECT_EQ(log.find("Mustermann"), std::string::npos);
  EXPECT_EQ(log.find(job), std::string::npos);
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) EXPECT_TRUE(Json::parse(line).contains("route")) << line;
}

/// Two sample crowns side by side, labelled by an array or by a file.
MeshFile two_crowns(bool with_array, Json& labels) {
  MeshFile scan;
  std::vector<double> numbers;
  for (const auto& [name, fdi, x] : {std::tuple("crown_34.ply", 34, -7.0), std::tuple("crown_36.stl", 36, 7.0)}) {
    TriangleMesh crown = load_mesh(fs::path(RHIZODONT_SOURCE_DIR) / "samples" / name).mesh;
    Point low = crown.vertices.front(), high = low;
    for (const Point& p : crown.vertices) low = low.cwiseMin(p), high = high.cwiseMax(p);
    for (Point& p : crown.vertices) p = nearest_float(p + Point(x, 0, 0) - 0.5 * (low + high));
    append_mesh(scan.mesh, crown);
    numbers.resize(scan.mesh.vertices.size(), fdi);
  }
  labels = {{"jaw", "lower"}, {"labels", std::vector<int>(numbers.begin(), numbers.end())}};
  if (with_array) scan.vertex_attributes["label"] = {AttributeType::int32, numbers};
  return scan;
}

TEST_F(ServiceTest, LabelledScanBecomesAnArch) {
  Json labels;
  const std::string bytes = mesh_file_bytes("scan.ply", two_crowns(true, labels));
  const Json sent = json_of(post("/api/v1/scans?name=scan.ply", bytes, "application/octet-stream"), 201);
  EXPECT_EQ(sent["kind"], "arch");
  const std::string job = start(
      {{"scan", sent["scan"]}, {"kind", "arch"}, {"options", {{"e_mm", 1}}}, {"root_lengths_mm", {{"36", 12.5}}}});
  const std::string told = events(job);
  EXPECT_NE(told.find("\"done\":2,\"teeth\":2"), std::string::npos) << told;
  const Json done = ended(job);
  ASSERT_EQ(done["state"], "done") << done.dump(1);
  ASSERT_EQ(done["arch"]["teeth"].size(), 2U);
  EXPECT_NEAR(done["arch"]["teeth"][1]["tooth"]["root_length_mm"].get<double>(), 12.5, 0.35);
  for (const char* name : {"all.zip", "arch.glb", "arch.json", "tooth_36.ply", "axes.json"})
    EXPECT_EQ(get("/api/v1/jobs/" + job + "/files/" + name)->status, 200) << name;
  const TriangleMesh all = read_mesh(get("/api/v1/jobs/" + job + "/files/arch.ply")->body, "arch.ply").mesh;
  for (const char* name : {"arch.stl", "arch.obj"}) {
    const auto file = get("/api/v1/jobs/" + job + "/files/" + name);
    ASSERT_EQ(file->status, 200) << name << " " << file->body;
    EXPECT_EQ(read_mesh(file->body, name).mesh.triangles.size(), all.triangles.size()) << name;
  }
  const auto view = get("/api/v1/jobs/" + job + "/views/tooth-36");
  ASSERT_EQ(view->status, 200);
  EXPECT_NE(header_of(view->body).dump().find("clearance"), std::string::npos);
  expect_refusal(get("/api/v1/jobs/" + job + "/views/tooth-11"), 404, "nothing");
  expect_refusal(post("/api/v1/jobs/" + job + "/steering", "{}"), 409, "no tooth");
}

TEST_F(ServiceTest, PersonCorrectsLabels) {
  Json labels;
  const MeshFile mesh = two_crowns(true, labels);
  const Point on_34 = mesh.mesh.vertices.front();
  const std::string bytes = mesh_file_bytes("scan.ply", mesh);
  const std::string scan = send(bytes, "scan.ply");
  const auto arch_with = [&](const Json& corrections, const Json& lengths = Json::object()) {
    return ended(start({{"scan", scan},
                        {"kind", "arch"},
                        {"options", {{"e_mm", 1}}},
                        {"corrections", corrections},
                        {"root_lengths_mm", lengths}}));
  };
  const auto teeth_of = [](const Json& done) {
    std::vector<int> teeth;
    for (const Json& tooth : done["arch"]["teeth"]) teeth.push_back(tooth["fdi"]);
    return teeth;
  };
  const Json first = arch_with(Json::array());
  EXPECT_EQ(first["arch"]["searched"], false);
  const Json numbered =
      arch_with(Json::parse(R"([{"number": 35, "at": )" + Json{on_34.x(), on_34.y(), on_34.z()}.dump() + "}]"));
  EXPECT_EQ(teeth_of(numbered), (std::vector{35, 36})) << numbered.dump(1);
  EXPECT_NE(numbered["arch"]["notes"].dump().find("34 was made 35"), std::string::npos);
  EXPECT_EQ(teeth_of(arch_with(Json::parse(R"([{"remove": 34}])"))), (std::vector{36}));
  EXPECT_EQ(arch_with(Json::parse(R"([{"remove": 11}])"))["error"]["sentence"], "The scan has no tooth 11 to correct.");
  // what was made before is taken from memory, and is the very same
  const Json again = arch_with(Json::array());
  ASSERT_EQ(again["state"], "done") << again.dump(1);
  EXPECT_EQ(again["arch"], first["arch"]);
  const Json longer = arch_with(Json::array(), {{"36", 12.5}});
  EXPECT_LT(longer["seconds"].get<double>(), first["seconds"].get<double>());
  const auto file = [&](const Json& job) {
    return get("/api/v1/jobs/" + job["job"].get<std::string>() + "/files/tooth_36.ply")->body;
  };
  Json given;
  const std::string other = send(mesh_file_bytes("scan.ply", two_crowns(true, given)), "scan.ply");
  const Json anew = ended(
      start({{"scan", other}, {"kind", "arch"}, {"options", {{"e_mm", 1}}}, {"root_lengths_mm", {{"36", 12.5}}}}));
  EXPECT_TRUE(file(longer) == file(anew));
  EXPECT_FALSE(file(longer) == file(first));
}

TEST_F(ServiceTest, LabelsMayComeInAFileOfTheirOwn) {
  Json labels;
  const std::string plain = send(mesh_file_bytes("scan.ply", two_crowns(false, labels)), "scan.ply");
  const Json unlabelled = ended(start({{"scan", plain}, {"kind", "arch"}}));
  EXPECT_EQ(unlabelled["state"], "refused");
  EXPECT_NE(std::string(unlabelled["error"]["sentence"]).find("Nothing tells this scan's teeth apart"),
            std::string::npos);
  const std::string scan = json_of(post("/api/v1/scans/" + plain + "/labels", labels.dump()), 201)["scan"];
  const Json done = ended(start({{"scan", scan}, {"kind", "arch"}, {"options", {{"e_mm", 1}}}}));
  ASSERT_EQ(done["state"], "done") << done.dump(1);
  EXPECT_EQ(done["arch"]["teeth"].size(), 2U);
}

TEST_F(ServiceTest, ServiceWithoutAFinderSaysWhatItNeeds) {
  Json labels;
  const Json sent = json_of(
      post("/api/v1/scans?name=s.ply", mesh_file_bytes("s.ply", two_crowns(false, labels)), "application/octet-stream"),
      201);
  EXPECT_EQ(sent["kind"], "arch") << "by its size";
  EXPECT_EQ(sent["has_labels"], false);
}

}  // namespace
}  // namespace rhizodont::test
