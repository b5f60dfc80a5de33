# SPDX-License-Identifier: MIT
"""/metrics of a wall with real programs and a viewer, read as Prometheus reads it; the dashboard and the alert rules
ask for nothing that is not there. promtool checks all of it where there is one."""
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest
from collections import defaultdict
from pathlib import Path

import yaml
from prometheus_client.parser import text_string_to_metric_families

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from wall import Wall, build_folder  # noqa: E402
from websocket import WebSocket  # noqa: E402
from xserver import XServer  # noqa: E402

STILL = build_folder() / "tests" / "still_windows"
HACK = "/usr/libexec/xscreensaver/atlantis"
DASHBOARD = ROOT / "deploy" / "grafana" / "wallgl.json"
RULES = ROOT / "deploy" / "prometheus" / "wallgl.rules.yml"
PROMTOOL = shutil.which("promtool")
NAME = re.compile(r"\b(?:wallgl|process)_[a-z0-9_]+\b")
OF_OTHERS = {"wallgl"}  # the job's name
SOON = 10.0  # seconds: programs and nodes tell once a second


class Scrape:
    """One answer of /metrics."""

    def __init__(self, text: str):
        self.text = text
        self.families = {family.name: family for family in text_string_to_metric_families(text)}
        self.samples = defaultdict(list)
        for family in self.families.values():
            for sample in family.samples:
                self.samples[sample.name].append(sample)

    def all(self, name: str, **labels: str) -> list[float]:
        return [s.value for s in self.samples[name] if labels.items() <= s.labels.items()]

    def sum(self, name: str, **labels: str) -> float:
        return sum(self.all(name, **labels))

    def with_label(self, key: str, value: str) -> set[str]:
        return {s.name for samples in self.samples.values() for s in samples if s.labels.get(key) == value}


def expressions(dashboard: dict) -> list[str]:
    """Of all panels, and of the variables."""
    out = [target["expr"] for panel in dashboard["panels"] for target in panel.get("targets", [])]
    return out + [v["definition"] for v in dashboard["templating"]["list"] if v["type"] == "query"]


def names_in(texts: list[str]) -> set[str]:
    return {name for text in texts for name in NAME.findall(text)}


class Metrics(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 2), tile_size=(200, 150)))
        cls.gears = cls.wall.run("glxgears", "-geometry", "400x300", rect=(0, 0, 400, 300), env=cls.x.environment(),
                                 stdout=subprocess.DEVNULL)
        cls.hack = cls.wall.run(HACK, "--window", "--geometry", "300x200", rect=(50, 50, 300, 200),
                                env=cls.x.environment(), stdout=subprocess.DEVNULL)
        cls.ids = [str(cls.wall.wait_session(app)) for app in (cls.gears, cls.hack)]
        for session in cls.ids:
            cls.wall.wait(session, 20)

    def scrape(self) -> Scrape:
        status, text = self.wall.rest("GET", "/metrics")
        self.assertEqual(status, 200)
        return Scrape(text)

    def until(self, done, what: str, limit: float = SOON) -> Scrape:
        end = time.monotonic() + limit
        while not done(now := self.scrape()):
            self.assertLess(time.monotonic(), end, f"{what}\n{now.text}")
            time.sleep(0.1)
        return now

    def watch(self) -> WebSocket:
        viewer = self.enterContext(WebSocket(self.wall.url))
        viewer.watch({"tile": "0-0"}, {"tile": "1-1", "width": 100, "height": 75, "codec": "huffyuv-tiles", "fps": 5})
        return viewer

    def read_frames(self, viewer: WebSocket, seconds: float) -> None:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            viewer.message(10)

    def test_everything_that_dashboard_and_rules_ask_for_is_exported(self) -> None:
        viewer = self.watch()
        self.read_frames(viewer, 2.5)
        exported = {sample.name for samples in self.scrape().samples.values() for sample in samples}
        rules = [rule["expr"] for group in yaml.safe_load(RULES.read_text())["groups"] for rule in group["rules"]]
        for source, wanted in (("dashboard", names_in(expressions(json.loads(DASHBOARD.read_text())))),
                               ("rules", names_in(rules))):
            self.assertGreater(len(wanted), 8, source)
            self.assertEqual(wanted - exported - OF_OTHERS, set(), source)
        documented = names_in([(ROOT / "docs" / "operation.md").read_text()])
        families = {name + "_total" if family.type == "counter" else name for name,
                    family in self.scrape().families.items()}
        self.assertEqual(families - documented, set(), "not in docs/operation.md")

    def test_programs_and_nodes_go_on(self) -> None:
        growing = [("wallgl_session_frames_total", {}), ("wallgl_session_sent_bytes_total", {"kind": "state"}),
                   ("wallgl_session_sent_bytes_total", {"kind": "geometry"}),
                   ("wallgl_session_received_bytes_total", {"kind": "geometry"}),
                   ("wallgl_session_rendered_frames_total", {}), ("wallgl_session_commands_total", {}),
                   ("wallgl_session_context_switches_total", {}), ("wallgl_session_decode_seconds_total", {}),
                   ("wallgl_session_render_seconds_total", {}), ("wallgl_session_diff_seconds_total", {})]
        first = self.until(lambda now: all(now.sum(name, session=id, **labels) > 0 for name,
                                           labels in growing for id in self.ids), "all figures are told")
        self.until(lambda now: all(now.sum(name, session=id, **labels) > first.sum(name, session=id, **labels) for name,
                                   labels in growing for id in self.ids), "all grow")
        for tile in self.wall.tile_names:
            self.assertLess(max(first.all("wallgl_tile_frame_age_seconds", tile=tile)), 2)
            self.assertGreater(first.sum("wallgl_tile_frames_total", tile=tile), 10)
        self.assertEqual(first.sum("wallgl_nodes", state="up"), 4)
        self.assertEqual(first.sum("wallgl_node_gl_errors_total"), 0)
        self.assertGreater(first.sum("wallgl_node_objects", kind="texture"), 8)
        for id in self.ids:
            buckets = first.all("wallgl_surface_rendered_skew_seconds_bucket", session=id)
            self.assertEqual(buckets, sorted(buckets), "a bucket holds those below")
            self.assertEqual(buckets[-1], first.sum("wallgl_surface_rendered_skew_seconds_count", session=id))
            self.assertGreater(buckets[-1], 10)

    def test_what_is_sent_is_what_is_executed(self) -> None:
        app = self.wall.run(STILL, "red", env=self.x.environment(), stdout=subprocess.DEVNULL)
        self.addCleanup(app.wait)
        self.addCleanup(app.kill)
        id = str(self.wall.wait_session(app))
        self.wall.wait(id, 1)

        def geometry(now: Scrape, name: str) -> dict[str, float]:
            return {s.labels["node"]: s.value for s in now.samples[name] if s.labels["session"] == id
                    and s.labels["kind"] == "geometry" and s.value > 0}

        sent, received = "wallgl_session_sent_bytes_total", "wallgl_session_received_bytes_total"
        self.until(lambda now: 0 < len(geometry(now, sent)) and geometry(now, sent) == geometry(now, received),
                   "both sides count the same")

    def test_an_ended_program_leaves_no_series(self) -> None:
        app = self.wall.run("glxgears", env=self.x.environment(), stdout=subprocess.DEVNULL)
        id = str(self.wall.wait_session(app))
        self.until(lambda now: {"wallgl_session_sent_bytes_total", "wallgl_session_received_bytes_total",
                                "wallgl_surface_presented_frames_total"} <= now.with_label("session", id),
                   "it has series")
        app.kill()
        app.wait()
        self.until(lambda now: not now.with_label("session", id), "it has none")

    def test_a_stream_has_series_while_it_is_watched(self) -> None:
        viewer = self.watch()
        self.read_frames(viewer, 2.5)
        now = self.scrape()
        self.assertEqual(now.sum("wallgl_viewers"), 1)
        self.assertEqual(now.all("wallgl_stream_viewers", tile="0-0", codec="huffyuv", size="200x150", fps="10",
                                 session=""), [1])
        for name in ("wallgl_stream_encoded_frames_total", "wallgl_stream_raw_bytes_total",
                     "wallgl_stream_packet_bytes_total", "wallgl_stream_encode_seconds_total",
                     "wallgl_stream_frames_total"):
            self.assertGreater(now.sum(name, tile="1-1"), 0, name)
        raw, packets = now.sum("wallgl_stream_raw_bytes_total",
                               tile="0-0"), now.sum("wallgl_stream_packet_bytes_total", tile="0-0")
        self.assertLess(packets, raw)
        self.assertEqual(raw, now.sum("wallgl_stream_encoded_frames_total", tile="0-0") * 200 * 150 * 4)
        viewer.socket.close()
        self.until(lambda now: not now.all("wallgl_stream_viewers") and now.sum("wallgl_viewers") == 0,
                   "the streams are gone")

    def test_a_node_that_is_away_says_nothing(self) -> None:
        name = "node-1-1"
        starts = self.scrape().sum("wallgl_node_starts_total", node=name)
        node = self.wall.daemons[name]
        node.kill()
        node.wait()
        away = self.until(lambda now: now.all("wallgl_node_up", node=name) == [0], "it is away")
        self.assertEqual(away.sum("wallgl_nodes", state="away"), 1)
        self.assertEqual(away.all("wallgl_node_frames_total", node=name), [])
        self.assertEqual(away.all("wallgl_session_received_bytes_total", node=name), [])
        self.wall.start_node(name)
        self.wall.wait_nodes()
        back = self.until(lambda now: now.sum("wallgl_node_frames_total", node=name) > 0, "it draws again")
        self.assertEqual(back.sum("wallgl_node_starts_total", node=name), starts + 1)

    def test_a_stopped_node_is_behind(self) -> None:
        node = self.wall.daemons["node-0-0"]
        os.kill(node.pid, signal.SIGSTOP)
        try:
            self.until(lambda now: now.sum("wallgl_tile_lag_frames", tile="0-0") > 0
                       and now.sum("wallgl_tile_frame_age_seconds", tile="0-0") > 1, "its tile is old")
        finally:
            os.kill(node.pid, signal.SIGCONT)
        now = self.until(lambda now: now.sum("wallgl_tile_lag_frames") == 0
                         and now.sum("wallgl_tile_frame_age_seconds", tile="0-0") < 1, "it has caught up")
        self.assertGreater(now.sum("wallgl_surface_swap_timeouts_total"), 0)

    @unittest.skipUnless(PROMTOOL, "no promtool here")
    def test_promtool_finds_nothing(self) -> None:
        self.read_frames(self.watch(), 1)
        checked = subprocess.run([PROMTOOL, "check", "metrics"], input=self.scrape().text, capture_output=True,
                                 text=True)
        self.assertEqual((checked.returncode, checked.stderr), (0, ""))
        for what, file in (("check rules", RULES), ("check config", RULES.with_name("prometheus.example.yml")),
                           ("test rules", Path(__file__).with_name("alerts.yml"))):
            checked = subprocess.run([PROMTOOL, *what.split(), file], capture_output=True, text=True)
            self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)


class Files(unittest.TestCase):
    def test_every_rule_says_what_is_wrong_and_how_bad_it_is(self) -> None:
        for group in yaml.safe_load(RULES.read_text())["groups"]:
            for rule in group["rules"]:
                with self.subTest(rule["alert"]):
                    self.assertIn(rule["labels"]["severity"], ("info", "warning", "critical"))
                    self.assertEqual(set(rule["annotations"]), {"summary", "description"})

    def test_the_dashboard_has_its_parts(self) -> None:
        dashboard = json.loads(DASHBOARD.read_text())
        self.assertEqual([p["title"] for p in dashboard["panels"] if p["type"] == "row"],
                         ["The wall", "Nodes", "Tiles", "Programs", "Live pictures"])
        ids = [panel["id"] for panel in dashboard["panels"]]
        self.assertEqual(len(ids), len(set(ids)))
        cells = [(x, y) for p in dashboard["panels"] for box in [p["gridPos"]]
                 for x in range(box["x"], box["x"] + box["w"]) for y in range(box["y"], box["y"] + box["h"])]
        self.assertEqual(len(cells), len(set(cells)), "panels overlap")


if __name__ == "__main__":
    unittest.main()
