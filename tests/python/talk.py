"""What hairpin says to an executor, said by hand."""
import json
import subprocess

import numpy as np


class Talk:
    def __init__(self, words, environment=None):
        self.program = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)
        self.ready = self.ask(type="hello", hairpin=2)

    def ask(self, **message):
        print(json.dumps(message), file=self.program.stdin, flush=True)
        return json.loads(self.program.stdout.readline())

    def fly(self, run=0, **mission):
        """The answer that ends it, and all poses."""
        of = {"case": "0000", "run": run}
        assert self.ask(type="reset", **of) == {"type": "ready", **of}
        answer, rows = self.ask(type="mission", **of, seed=1, **mission), []
        while answer["type"] == "poses":
            assert (answer["case"], answer["run"]) == ("0000", run)
            rows += answer["poses"]
            answer = json.loads(self.program.stdout.readline())
        return answer, np.array(rows)

    def end(self):
        self.program.communicate('{"type":"bye"}\n', timeout=10)
        return self.program.returncode

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.program.terminate()  # it ends what it started
        self.program.communicate(timeout=10)
