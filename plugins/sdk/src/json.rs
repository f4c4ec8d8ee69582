//! JSON written while a plugin compiles.

/// A text of at most `N` bytes that knows how long it would have become. With `N` = 0 it only counts.
pub struct Json<const N: usize> {
    bytes: [u8; N],
    length: usize,
}

impl<const N: usize> Json<N> {
    pub const fn new() -> Self {
        Self { bytes: [0; N], length: 0 }
    }

    /// How long the text is, written or not.
    pub const fn length(&self) -> usize {
        self.length
    }

    /// The text, where it has exactly `N` bytes.
    pub const fn finish(self) -> [u8; N] {
        assert!(self.length == N, "the text is as long as was counted");
        self.bytes
    }

    const fn byte(&mut self, byte: u8) {
        if self.length < N {
            self.bytes[self.length] = byte;
        }
        self.length += 1;
    }

    /// As it is.
    pub const fn raw(&mut self, text: &str) {
        let bytes = text.as_bytes();
        let mut at = 0;
        while at < bytes.len() {
            self.byte(bytes[at]);
            at += 1;
        }
    }

    const fn escaped(&mut self, text: &str) {
        let bytes = text.as_bytes();
        let mut at = 0;
        while at < bytes.len() {
            match bytes[at] {
                b'"' => self.raw("\\\""),
                b'\\' => self.raw("\\\\"),
                control if control < 0x20 => {
                    self.raw("\\u00");
                    self.byte(b"0123456789abcdef"[(control >> 4) as usize]);
                    self.byte(b"0123456789abcdef"[(control & 15) as usize]);
                }
                other => self.byte(other),
            }
            at += 1;
        }
    }

    /// In quotes, escaped.
    pub const fn string(&mut self, text: &str) {
        self.byte(b'"');
        self.escaped(text);
        self.byte(b'"');
    }

    /// The first paragraph of a documentation comment, as one line in quotes.
    pub const fn paragraph(&mut self, lines: &[&str]) {
        self.byte(b'"');
        let mut at = 0;
        while at < lines.len() {
            let line = lines[at].trim_ascii();
            if line.is_empty() {
                break;
            }
            if at > 0 {
                self.byte(b' ');
            }
            self.escaped(line);
            at += 1;
        }
        self.byte(b'"');
    }

    /// A number from 0 up.
    pub const fn count(&mut self, value: usize) {
        if value >= 10 {
            self.count(value / 10);
        }
        self.byte(b'0' + (value % 10) as u8);
    }

    pub const fn boolean(&mut self, value: bool) {
        self.raw(if value { "true" } else { "false" });
    }
}

impl<const N: usize> Default for Json<N> {
    fn default() -> Self {
        Self::new()
    }
}

/// Whether a Rust literal is a number in JSON too: `0.3`, `-1`, `1e-3`, but not `1.`, `.5`, `1_000` or `1f32`.
pub const fn is_number(text: &str) -> bool {
    let text = text.as_bytes();
    let at = if !text.is_empty() && text[0] == b'-' { 1 } else { 0 };
    let whole = digits(text, at);
    let leads_with_zero = whole > at + 1 && text[at] == b'0';
    if whole == at || leads_with_zero {
        return false;
    }
    let mut at = whole;
    if at < text.len() && text[at] == b'.' {
        let end = digits(text, at + 1);
        if end == at + 1 {
            return false;
        }
        at = end;
    }
    if at < text.len() && (text[at] == b'e' || text[at] == b'E') {
        let signed = at + 1 < text.len() && (text[at + 1] == b'-' || text[at + 1] == b'+');
        let begin = if signed { at + 2 } else { at + 1 };
        let end = digits(text, begin);
        if end == begin {
            return false;
        }
        at = end;
    }
    at == text.len()
}

/// Where the digits from `at` on end.
const fn digits(text: &[u8], mut at: usize) -> usize {
    while at < text.len() && text[at].is_ascii_digit() {
        at += 1;
    }
    at
}

/// The bytes of a text as an array; `N` is its length.
pub const fn array<const N: usize>(text: &str) -> [u8; N] {
    let mut json = Json::<N>::new();
    json.raw(text);
    json.finish()
}

/// What [`Json`] wrote.
pub const fn text(bytes: &[u8]) -> &str {
    match core::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(_) => panic!("JSON is UTF-8"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_json() {
        for good in ["0", "-1", "0.3", "-0.25", "10.0", "1e-3", "2.5E+7"] {
            assert!(is_number(good), "{good}");
        }
        for bad in ["", "-", "1.", ".5", "1_000", "1f32", "01", "1e", "0x10", "inf", "1.5.2"] {
            assert!(!is_number(bad), "{bad}");
        }
    }

    #[test]
    fn strings_are_escaped() {
        let mut json = Json::<64>::new();
        json.string("a \"b\" \\ \n ω");
        assert_eq!(text(&json.bytes[..json.length]), r#""a \"b\" \\ \u000a ω""#);
    }

    #[test]
    fn a_comment_gives_its_first_paragraph_as_one_line() {
        let mut json = Json::<64>::new();
        json.paragraph(&[" One", "  sentence.", "", " Another."]);
        assert_eq!(text(&json.bytes[..json.length]), r#""One sentence.""#);
    }

    #[test]
    fn counting_gives_the_length_of_writing() {
        let mut counted = Json::<0>::new();
        let mut written = Json::<12>::new();
        counted.count(4096);
        written.count(4096);
        assert_eq!((counted.length(), text(&written.bytes[..4])), (4, "4096"));
    }
}
