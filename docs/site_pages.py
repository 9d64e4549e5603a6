"""A hook of MkDocs: the pages of the documentation site, and their links."""

import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

_ROOT = Path(__file__).resolve().parents[1]
_PUBLISHED = ("*.md", "docs/**/*.md", "docs/images/*", "conformance/*.md", "corpus/*/*.md")
_LINK = re.compile(r"(?<=\]\()[^)#:]+")


def on_files(files: Files, *, config: MkDocsConfig) -> Files:
    """The files of the theme, and our documents at their paths in the repository."""
    paths = sorted(path for pattern in _PUBLISHED for path in _ROOT.glob(pattern))
    ours = (
        File(
            path.relative_to(_ROOT).as_posix(), str(_ROOT), config.site_dir, use_directory_urls=True
        )
        for path in paths
    )
    return Files([*(file for file in files if file.src_dir != config.docs_dir), *ours])


def on_page_markdown(markdown: str, *, page: Page, config: MkDocsConfig, files: Files) -> str:
    """The text of a page; a link to a file that is not on the site leads to the repository."""

    def lead(link: re.Match[str]) -> str:
        target = (_ROOT / page.file.src_uri).parent.joinpath(link[0]).resolve()
        if not (target.is_relative_to(_ROOT) and target.exists()):
            return link[0]  # a dead link, of which MkDocs warns
        path = target.relative_to(_ROOT).as_posix()
        return link[0] if files.get_file_from_path(path) else f"{config.repo_url}/blob/HEAD/{path}"

    return _LINK.sub(lead, markdown)
