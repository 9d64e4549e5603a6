"""The elements of a page."""

from html.parser import HTMLParser

LOADING_ATTRIBUTES = {"src", "srcset", "href", "data", "action", "formaction", "poster"}


class Elements(HTMLParser):
    """Every start tag of a page, and the text of its scripts and style sheets."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.raw: list[str] = []
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Keep a start tag."""
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        """Keep text that no person reads."""
        if self.tags and self.tags[-1][0] in {"script", "style"}:
            self.raw.append(data)
