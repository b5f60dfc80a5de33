# SPDX-License-Identifier: MIT
"""A wall whose tiles are any rectangles and change while it runs: wall.toml is written anew, and read again by `wallctl
reload` or SIGHUP."""
from __future__ import annotations

import json
import signal
import subprocess

from wall import Wall

Plan = dict[str, dict[str, tuple[int, int, int, int]]]  # node -> tile -> rectangle


class PlannedWall(Wall):
    """Options that are not here are those of Wall. `tiles` and `tile_size` of that mean nothing. `keys` are further
    lines of a tile in wall.toml, `node_keys` of a node."""

    def __init__(self, plan: Plan, keys: dict[str, str] | None = None,
                 node_keys: dict[str, str] | None = None, **options):
        super().__init__(**options)
        self.plan, self.keys, self.node_keys = plan, keys or {}, node_keys or {}

    @property
    def node_names(self) -> list[str]:
        return list(self.plan)

    @property
    def tile_names(self) -> list[str]:
        return [tile for tiles in self.plan.values() for tile in tiles]

    def node_text(self, name: str, tiles: dict[str, tuple[int, int, int, int]]) -> str:
        """Its part of wall.toml."""
        return self._node(name, []) + self.node_keys.get(name, "") + "\n" + "".join(
            f"[[node.tile]]\nname = {json.dumps(tile)}\nrect = {list(rect)}\n{self.keys.get(tile, '')}\n"
            for tile, rect in tiles.items())

    def _description(self) -> str:
        return self._but_nodes() + "".join(self.node_text(*node) for node in self.plan.items())

    def write(self, plan: Plan) -> None:
        """wall.toml as it shall be; nobody has read it yet."""
        self.plan = plan
        (self.folder / "wall.toml").write_text(self._description())

    def reload(self, plan: Plan, *, by_signal: bool = False) -> None:
        """Until all nodes of the new plan are up. Tileservers of new nodes are started; others are not touched."""
        self.write(plan)
        if by_signal:
            self.daemons["walld"].send_signal(signal.SIGHUP)
            self._until(lambda: {n["name"] for n in self.nodes()} == set(plan), "the wall has other nodes", "walld")
        else:
            self.ctl("reload")
        for name in plan:
            if name not in self.daemons:
                self.start_node(name)
        self.wait_nodes()

    def start_node_of(self, name: str, description: str) -> subprocess.Popen:
        """A tileserver that reads a wall.toml of its own, as on a machine of its own."""
        path = self.folder / f"{name}.toml"
        path.write_text(description)
        return self._start_daemon(name, "tileserver", "--config", path, "--node", name)
