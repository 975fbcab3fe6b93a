"""The command-line tool, for the scripts that draw figures and tables with it."""
import json
import os
import subprocess


class Tool:
    """Runs the tool at `path`; models and meshes that it makes go to `folder`."""

    def __init__(self, path, folder):
        self.path, self.folder = os.path.abspath(path), folder

    def __call__(self, *arguments):
        done = subprocess.run([self.path, *arguments], check=True, capture_output=True, text=True)
        return done.stdout

    def json(self, *arguments):
        return json.loads(self(*arguments, "--json"))

    def file(self, name):
        return os.path.join(self.folder, name)

    def build(self, name, mesh, *options):
        """A patch tree and what was said of it."""
        model = self.file(name + ".vfm")
        report = self.json("build", "patchtree", mesh, "-o", model, *options)
        return model, report
