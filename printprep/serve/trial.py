"""The model with one setting after another: a run in the background, its progress, its page."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from printprep.errors import PrintprepError
from printprep.page.build import page_of_checked, page_of_result, source_of
from printprep.page.content import Form
from printprep.page.document import document
from printprep.pipeline.job import Job, check_settings
from printprep.pipeline.options import FillOptions, Placement
from printprep.progress import STAGES, Stage
from printprep.serve.settings import Settings

if TYPE_CHECKING:
    from printprep.page.content import Page
    from printprep.pipeline.look import Looked
    from printprep.profiles import Profile


class SupersededError(Exception):
    """Another run has begun, so this one ends at its next stage."""


@dataclass(frozen=True)
class State:
    """What a page is told about its run, under the names that ``web/src/serve.js`` reads.

    run : number of the newest run, 0 before the first;  stage : in words, None between stages.
    """

    run: int
    busy: bool
    stage: str | None
    seconds: float
    error: str | None
    hint: str | None


@dataclass(frozen=True)
class Outcome:
    """A page, and the part's 3MF where there is one."""

    page: bytes
    part: bytes | None


class Trials:
    """Runs of one model; the newest counts, and an older one that is at work gives up."""

    def __init__(
        self,
        model: Path,
        profile: str | Path | Profile,
        overrides: Mapping[str, object],
        placement: Placement,
        lean: str | None,
        looked: Looked,
    ) -> None:
        from printprep.profiles import load_profile

        self._model = model
        self._profile = load_profile(profile, overrides)
        self._looked = looked
        self._template = Job(
            model=model,
            output=Path(f"{model.stem}-hollow.3mf"),
            profile=self._profile,
            placement=placement,
            options=FillOptions(lean=lean),
        )
        self._lock = threading.Lock()
        self._state = State(0, False, None, 0.0, None, None)
        self._started = time.monotonic()
        first = page_of_checked(
            looked.checked,
            source_of(model),
            name=looked.name,
            poses=looked.poses,
            points=looked.points,
            form=self._form(Settings(lean=lean or ""), can_download=False),
        )
        self._outcome = Outcome(document(first), None)

    @property
    def state(self) -> State:
        """The newest run, as it is now."""
        with self._lock:
            seconds = time.monotonic() - self._started if self._state.busy else self._state.seconds
            return replace(self._state, seconds=seconds)

    @property
    def outcome(self) -> Outcome:
        """The page of the newest run that ended well, at first that of the model as it is."""
        with self._lock:
            return self._outcome

    def start(self, settings: Settings) -> int:
        """Begin a run; return its number.  Raises UsageError for settings that cannot be."""
        job = settings.job(self._template)
        check_settings(job)
        with self._lock:
            number = self._state.run + 1
            self._state = State(number, True, None, 0.0, None, None)
            self._started = time.monotonic()
        threading.Thread(target=self._run, args=(number, job, settings), daemon=True).start()
        return number

    def _run(self, number: int, job: Job, settings: Settings) -> None:
        try:
            outcome = self._hollowed(number, job, settings)
        except SupersededError:
            return
        except PrintprepError as error:
            self._end(number, error=error.message, hint=error.hint)
        except Exception as error:  # the boundary of a thread: the page must learn of a defect too
            self._end(
                number, error=f"This is a defect of printprep: {type(error).__name__}: {error}"
            )
        else:
            self._end(number, outcome)

    def _hollowed(self, number: int, job: Job, settings: Settings) -> Outcome:
        from printprep.output.part_file import part_bytes
        from printprep.pipeline.hollow import hollow_with
        from printprep.profiles import load_profile

        progress = _Told(self, number)
        profile = load_profile(job.profile, job.overrides)
        result = hollow_with(job.model, profile, job.placement, job.options, progress)
        with progress.stage("write"):
            part = part_bytes(result.contents(), ".3mf")
        with progress.stage("page"):
            command = settings.command(self._model.name, self._profile.name)
            page: Page = page_of_result(
                result,
                result.findings,
                source_of(self._model, command),
                form=self._form(settings, can_download=True),
            )
            return Outcome(document(page), part)

    def _form(self, settings: Settings, *, can_download: bool) -> Form:
        poses = [("", "as in the file")]
        poses += [
            (str(number), f"{number}: tips at {pose.tilt_deg:.1f}°")
            for number, pose in enumerate(self._looked.poses, 1)
        ]
        fills = [("cavity", "cavity")]
        if self._profile.infill is not None:
            fills.append(("infill", "infill"))
        return Form(
            wall_mm=settings.wall or f"{self._profile.wall_mm:g}",
            lean=settings.lean or f"{self._profile.stability.lean_deg:g}",
            fill=settings.fill,
            fills=tuple(fills),
            drains=settings.drains or str(self._profile.drain.count),
            pose=settings.pose,
            poses=tuple(poses),
            can_download=can_download,
            download_name=f"{self._looked.name}-hollow.3mf",
        )

    def enter(self, number: int, stage: Stage) -> None:
        """Tell that a run is at a stage.  Raises SupersededError where a newer one began."""
        with self._lock:
            if self._state.run != number:
                raise SupersededError
            self._state = replace(self._state, stage=STAGES[stage])

    def _end(
        self,
        number: int,
        outcome: Outcome | None = None,
        *,
        error: str | None = None,
        hint: str | None = None,
    ) -> None:
        with self._lock:
            if self._state.run != number:
                return
            seconds = time.monotonic() - self._started
            self._state = State(number, False, None, seconds, error, hint)
            if outcome is not None:
                self._outcome = outcome


class _Told:
    """Passes the stages of a run on to the page."""

    def __init__(self, trials: Trials, number: int) -> None:
        self._trials, self._number = trials, number

    def stage(self, name: Stage) -> AbstractContextManager[None]:
        self._trials.enter(self._number, name)
        return contextlib.nullcontext()


def state_json(state: State) -> dict[str, Any]:
    """A state as plain values."""
    return {
        "run": state.run,
        "busy": state.busy,
        "stage": state.stage,
        "seconds": round(state.seconds, 2),
        "error": state.error,
        "hint": state.hint,
    }
