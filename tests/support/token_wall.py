# SPDX-License-Identifier: MIT
"""A wall of several machines whose page is there for them, too: over TLS, for people with a token."""
from __future__ import annotations

from machine_wall import WALLD, MachineWall

PAGE_PORT = 7780
TOKENS = {"looks": ("viewer", "a-secret-of-those-who-look"), "leads": ("operator", "a-secret-of-those-who-lead"),
          "guest": ("user", "a-secret-of-some-guest")}
SECRETS = {name: secret for name, (_, secret) in TOKENS.items()}


class TokenWall(MachineWall):
    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        self._others = self.people
        self.http = ["127.0.0.1:0", f"{self.page_address[0]}:{PAGE_PORT}"]

    @property
    def page_address(self) -> tuple[str, int]:
        return self.hosts.address(WALLD), PAGE_PORT

    @property
    def page_url(self) -> str:
        return f"https://{self.page_address[0]}:{PAGE_PORT}"

    def _description(self) -> str:
        self.people = self._others
        for name, (role, secret) in TOKENS.items():
            file = self.folder / name
            file.write_text(secret)
            file.chmod(0o600)
            self.people += f'[[people.token]]\nname = "{name}"\nfile = "{file}"\nrole = "{role}"\n'
        return super()._description()
