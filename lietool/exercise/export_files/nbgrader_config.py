"""The course of exercises: nbgrader reads this file in the folder that it is run in."""

import os
from pathlib import Path

c = get_config()  # noqa: F821 - nbgrader defines it

# The name of the course at the exchange: change it to yours.
c.CourseDirectory.course_id = "lietool"
# In seconds for a cell: the first check of a notebook grades all, and a function may hang in each of them.
c.ExecutePreprocessor.timeout = 600

_project = Path(__file__).resolve().parent / "project"
if _project.is_dir():
    # Kernels inherit it, and find the exercises there.
    os.environ["LIETOOL_PROJECT"] = str(_project)
