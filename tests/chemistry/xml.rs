//! The reader of XML: places, namespaces, references, what is refused, and that nothing makes it panic.

use pseudopod::equations;
use pseudopod::error::{Paint, Source, render};
use pseudopod::xml::{Characters, Document, Event, Limits, Reader, Trouble, What};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

const LIMITS: Limits = Limits { bytes: 64 << 20, depth: 100, nodes: 1_000_000, attributes: 100_000 };

fn read(text: &str) -> Result<Document<'_>, Trouble> {
    Document::read(text, LIMITS)
}

/// All events of a document, each as its kind, what it says, and the piece of the source at its bytes.
fn events(text: &str) -> Vec<(&'static str, String, String)> {
    let mut reader = Reader::new(text, LIMITS).expect("XML");
    let piece = |at: Range<usize>| text[at].to_owned();
    let mut found = Vec::new();
    while let Some(event) = reader.event().expect("well-formed") {
        match event {
            Event::Start(start) => {
                let space = start.namespace.map_or("", |namespace| reader.namespace(namespace));
                found.push(("start", format!("{space}|{}", start.name), piece(start.at)));
                found.push(("name", start.name.to_owned(), piece(start.name_at)));
                for one in reader.attributes() {
                    let space = one.namespace.map_or("", |namespace| reader.namespace(namespace));
                    found.push(("attribute", format!("{space}|{}", one.name), piece(one.name_at(text))));
                    found.push(("value", one.value.clone().into_owned(), piece(one.value_at())));
                }
            }
            Event::Text { text, at } => found.push(("text", text.into_owned(), piece(at))),
            Event::End { at } => found.push(("end", String::new(), piece(at))),
        }
    }
    found
}

#[test]
fn every_part_has_its_bytes() {
    let text = "\u{feff}<?xml version=\"1.0\"?>\n<!-- first --><?style a?>\n<p:ä xmlns:p = 'u'\n b=\"1 &lt;\t2\r\n3\" p:c='\"'>µ&#181;\r\n\
                <![CDATA[<&\r\n]]><!-- x -->y<z /></p:ä >\n<!-- last -->\n";
    let expected = [
        ("start", "u|ä", "<p:ä xmlns:p = 'u'\n b=\"1 &lt;\t2\r\n3\" p:c='\"'>"),
        ("name", "ä", "p:ä"),
        ("attribute", "|b", "b"),
        ("value", "1 < 2 3", "1 &lt;\t2\r\n3"),
        ("attribute", "u|c", "p:c"),
        ("value", "\"", "\""),
        ("text", "µ", "µ"),
        ("text", "µ", "&#181;"),
        ("text", "\n", "\r\n"),
        ("text", "<&\n", "<![CDATA[<&\r\n]]>"),
        ("text", "y", "y"),
        ("start", "|z", "<z />"),
        ("name", "z", "z"),
        ("end", "", "<z />"),
        ("end", "", "</p:ä >"),
    ];
    let expected: Vec<_> = expected.iter().map(|(kind, says, at)| (*kind, says.to_string(), at.to_string())).collect();
    assert_eq!(events(text), expected);
}

#[test]
fn a_tree_has_parents_children_and_texts_in_one_piece() {
    let text = "<a x='1'>one&amp;<![CDATA[two]]><!-- --> <b><c/></b>three</a>";
    let document = read(text).expect("well-formed");
    let a = document.root();
    assert!(a.parent().is_none() && a.attribute("x") == Some("1") && a.attribute("y").is_none());
    let children: Vec<_> = a.children().map(|node| (node.name(), node.text(), &text[node.at()])).collect();
    let first = ("", Some("one&two"), "one&amp;<![CDATA[two]]>");
    let rest = [("", Some(" "), " "), ("b", None, "<b><c/></b>"), ("", Some("three"), "three")];
    assert_eq!(children, [[first].as_slice(), &rest].concat());
    let b = a.elements().next().expect("an element");
    assert_eq!((&text[b.tag_at()], &text[b.name_at()], b.parent().map(|up| up.index())), ("<b>", "b", Some(0)));
    let all: Vec<&str> = a.descendants().filter(|node| node.is_element()).map(|node| node.name()).collect();
    assert_eq!(all, ["a", "b", "c"]);
}

#[test]
fn namespaces_hold_where_they_are_declared() {
    let text = "<a xmlns='one' xmlns:p='two'><p:b q:c='1' xmlns:q='three' c='2' xml:lang='en'><d xmlns='' xmlns:p='four'><p:e/></d>\
                <f/></p:b><g xmlns='one'/></a>";
    let document = read(text).expect("well-formed");
    let elements = document.root().descendants();
    let spaces: Vec<_> = elements.map(|node| (node.name(), node.namespace().unwrap_or("none"))).collect();
    let expected = [("a", "one"), ("b", "two"), ("d", "none"), ("e", "four"), ("f", "one"), ("g", "one")];
    assert_eq!(spaces, expected);
    let b = document.root().elements().next().expect("an element");
    assert_eq!((b.attribute("c"), b.attribute_of("three", "c")), (Some("2"), Some("1")));
    assert_eq!(b.attribute_of(pseudopod::xml::XML, "lang"), Some("en"));
    assert_eq!(document.namespaces().collect::<Vec<_>>(), ["one", "two", "three", "four"]);
}

#[test]
fn characters_know_where_they_come_from() {
    let text = "a&lt;<![CDATA[&lt;µ]]>&#x1F600;]]";
    let found: Vec<(char, &str)> =
        Characters::new(text, 0..text.len()).map(|(c, at)| (c, text.get(at).expect("on characters"))).collect();
    let expected = [
        ('a', "a"),
        ('<', "&lt;"),
        ('&', "&"),
        ('l', "l"),
        ('t', "t"),
        (';', ";"),
        ('µ', "µ"),
        ('😀', "&#x1F600;"),
        (']', "]"),
        (']', "]"),
    ];
    assert_eq!(found, expected);
}

/// Texts that are no well-formed XML: what the message says, and what is marked.
const MALFORMED: [(&str, &str, &str); 58] = [
    ("<a><b></a>", "found </a>, expected </b> (opened at line 1, column 4)", "</a>"),
    ("<a>\n  <p:b xmlns:p='u'></b></a>", "found </b>, expected </p:b> (opened at line 2, column 3)", "</b>"),
    ("<a></a b>", "found </a b>, expected </a>", "</a b>"),
    ("<a></>", "found </>, expected </a>", "</>"),
    ("</a>", "</a> closes no element", "</a>"),
    ("<a/></a>", "</a> closes no element", "</a>"),
    ("<a><b>", "<b> is not closed", "b"),
    ("<a>text", "<a> is not closed", "a"),
    ("<a", "a tag is not closed", "<a"),
    ("<a b='1", "a tag is not closed", "<a"),
    ("<a b='1>\n<c d=\"e'\"/></a>", "a tag is not closed", "<a"),
    ("<a><b</a>", "`<` stands within a tag", "<"),
    ("<a b='1'\n<c d='2'/></a>", "`<` stands within a tag", "<"),
    ("<a b\n<c/></a>", "`<` stands within a tag", "<"),
    ("<", "`<` begins no element here", "<"),
    ("<a>1 < 2</a>", "`<` begins no element here", "<"),
    ("<a>1 < 2", "`<` begins no element here", "<"),
    ("<>", "`<` begins no element here", "<"),
    ("<1a/>", "`1a` is not a name", "1a"),
    ("<a:b:c/>", "`a:b:c` is not a name", "a:b:c"),
    ("<:a/>", "`:a` is not a name", ":a"),
    ("<a:/>", "`a:` is not a name", "a:"),
    ("<a/b='1'/>", "`a/b='1'` is not a name", "a/b='1'"),
    ("<a b/>", "an attribute has no value", "/"),
    ("<a b c='1'/>", "an attribute has no value", "c"),
    ("<a b=/>", "an attribute has no value", "/"),
    ("<a b=1/>", "the value of an attribute has no quotes", "1"),
    ("<a b=µ c='1'/>", "the value of an attribute has no quotes", "µ"),
    ("<a b='1'c='2'/>", "a blank is missing", "c"),
    ("<a 1='1'/>", "`1` is not a name", "1"),
    ("<a ='1'/>", "an attribute has no value", "/"),
    ("<a b='1' c='2' b='3'/>", "`b` stands twice in one element, first at line 1, column 4", "b"),
    (
        "<a xmlns:p='u' xmlns:q='u'\n p:b='1' q:b='2'/>",
        "`q:b` stands twice in one element, first at line 2, column 2",
        "q:b",
    ),
    ("<a xmlns='u' xmlns='v'/>", "declares this prefix twice", "xmlns"),
    ("<a xmlns:p='u' xmlns:p='u'/>", "declares this prefix twice", "xmlns:p"),
    ("<a b='1 < 2'/>", "`<` stands in the value of an attribute", "<"),
    ("<a b='1 & 2'/>", "`&` begins a reference that no `;` ends", "&"),
    ("<a b='&nbsp;'/>", "`&nbsp;` stands for nothing", "&nbsp;"),
    ("<a>1 & 2</a>", "`&` begins a reference that no `;` ends", "&"),
    ("<a>&nbsp;</a>", "`&nbsp;` stands for nothing", "&nbsp;"),
    ("<a>&#0;</a>", "`&#0;` stands for nothing", "&#0;"),
    ("<a>&#xD800;</a>", "`&#xD800;` stands for nothing", "&#xD800;"),
    ("<a>&#+65;&#x;</a>", "`&#+65;` stands for nothing", "&#+65;"),
    ("<a>&#99999999999;</a>", "`&#99999999999;` stands for nothing", "&#99999999999;"),
    ("<p:a/>", "the prefix `p` stands for no namespace", "p"),
    ("<a><b xmlns:p='u'/><p:c/></a>", "the prefix `p` stands for no namespace", "p"),
    ("<a xmlns:p='u'><b xmlns:p='' p:c='1'/></a>", "the prefix `p` stands for no namespace", "p"),
    ("<xmlns:a/>", "the prefix `xmlns` stands for no namespace", "xmlns"),
    ("<a xmlns:xml='u'/>", "are reserved", "xmlns:xml"),
    ("<a xmlns='http://www.w3.org/2000/xmlns/'/>", "are reserved", "xmlns"),
    ("<a>]]></a>", "`]]>` stands in a text", "]]>"),
    ("<a><!-- b", "a comment is not closed", "<!--"),
    ("<a><!-- b -- c --></a>", "`--` stands in a comment", "--"),
    ("<a><![CDATA[ ]] > </a>", "a CDATA section is not closed", "<![CDATA["),
    ("<a><?b </a>", "a processing instruction is not closed", "<?"),
    ("<a><? b?></a>", "`` is not a name", ""),
    (" <?xml version='1.0'?><a/>", "this is not where or how XML is declared", "<?xml version='1.0'?>"),
    ("<?xml encoding='UTF-8'?><a/>", "this is not where or how XML is declared", "<?xml encoding='UTF-8'?>"),
];

/// More of them, about what stands around the root element and about characters.
const AROUND: [(&str, &str, &str); 8] = [
    ("<a/><b/>", "a document has one element around all others", "b"),
    ("<a/> text ", "a text stands outside of the root element", "text"),
    ("<a/>&amp;", "a text stands outside of the root element", "&amp;"),
    ("<![CDATA[ ]]><a/>", "a text stands outside of the root element", "<![CDATA[ ]]>"),
    ("<!-- only -->", "there is no element in the document", ""),
    ("<a>\u{b}</a>", "the character U+000B cannot stand in XML", "\u{b}"),
    ("<a>µ\u{ffff}</a>", "the character U+FFFF cannot stand in XML", "\u{ffff}"),
    ("<a b='\0'/>", "the character U+0000 cannot stand in XML", "\0"),
];

#[test]
fn what_is_not_well_formed_is_told_at_its_location() {
    for (text, part, marked) in MALFORMED.iter().chain(&AROUND) {
        let trouble = read(text).expect_err(text);
        let What::Malformed { message, help, .. } = trouble.what else { panic!("{text}: {trouble:?}") };
        assert!(message.contains(part) && !help.is_empty(), "{text}: {message}");
        assert_eq!(&text[trouble.at], *marked, "{text}: {message}");
    }
}

#[test]
fn what_does_not_belong_in_a_document_is_refused() {
    let refused = |text: &str, limits: Limits| {
        let trouble = Document::read(text, limits).expect_err(text);
        (trouble.what, trouble.at.start)
    };
    for text in ["", "  \n", "a", "\u{feff}a", "title = \"TOML\""] {
        assert_eq!(refused(text, LIMITS).0, What::NotXml, "{text}");
    }
    for text in
        ["<!DOCTYPE a><a/>", "<!DOCTYPE a [<!ENTITY b \"c\">]><a/>", "<!DOCTYPE", "<!ELEMENT a EMPTY><a/>", "<!"]
    {
        assert_eq!(refused(text, LIMITS), (What::DocumentType, 0), "{text}");
    }
    assert_eq!(refused("<a><!doctype b></a>", LIMITS), (What::DocumentType, 3));
    assert_eq!(refused("<a/>", Limits { bytes: 3, ..LIMITS }).0, What::TooLong);
    assert_eq!(refused("<a><b><c></c></b></a>", Limits { depth: 2, ..LIMITS }), (What::TooDeep, 6));
    assert_eq!(refused("<a>µ<b/></a>", Limits { nodes: 2, ..LIMITS }), (What::TooManyNodes, 5));
    assert_eq!(refused("<a>µ<b/></a>", Limits { nodes: 1, ..LIMITS }), (What::TooManyNodes, 3));
    assert_eq!(refused("<a><b c='' d=''/></a>", Limits { attributes: 1, ..LIMITS }), (What::TooManyAttributes, 3));
    let within = Limits { bytes: 21, depth: 2, nodes: 2, attributes: 2 };
    assert!(Document::read("<a><b c='' d=''/></a>", within).is_ok());
}

#[test]
fn large_documents_take_time_in_proportion() {
    let many = |count: usize, make: &dyn Fn(usize) -> String| (0..count).map(make).collect::<String>();
    let nested = format!(
        "{}{}{}",
        many(90, &|i| format!("<a{}>", many(1000, &|j| format!(" xmlns:p{}='u{j}'", 1000 * i + j)))),
        "<p0:b/>".repeat(100_000),
        "</a>".repeat(90)
    );
    let texts = [
        ("attributes", format!("<a{}/>", many(90_000, &|i| format!(" a{i}='1'")))),
        ("attributes with a prefix", format!("<a xmlns:p='u'{}/>", many(90_000, &|i| format!(" p:a{i}='1'")))),
        ("namespaces", format!("<a{}/>", many(90_000, &|i| format!(" xmlns:a{i}='u{i}'")))),
        ("many declarations around", nested),
        ("elements", format!("<a>{}</a>", "<b/>".repeat(900_000))),
        ("references", format!("<a b='{0}'>{0}</a>", "&lt;".repeat(1_000_000))),
        ("sections", format!("<a>{}</a>", "<![CDATA[]]]]>".repeat(1_000_000))),
        ("comments", format!("<a>{}</a>", "<!---->".repeat(1_000_000))),
    ];
    for (name, text) in texts {
        let begin = Instant::now();
        assert!(read(&text).is_ok(), "{name}");
        assert!(begin.elapsed() < Duration::from_secs(5), "{name} took {:?}", begin.elapsed());
    }
}

#[test]
fn forty_thousand_attributes_are_told_at_once() {
    let many: String = (0..40_000).map(|i| format!(" a{i}=\"1\"")).collect();
    for text in [format!("<eml name=\"a\"{many}/>"), format!("<sbml{many}/>")] {
        let begin = Instant::now();
        let error = equations::read(Arc::new(Source { name: "many".into(), text })).expect_err("too many");
        let message = render(&error, Paint::Plain);
        assert!(message.contains("an element has more than 1000 attributes"), "{message}");
        assert!(begin.elapsed() < Duration::from_secs(1), "took {:?}", begin.elapsed());
    }
}

#[test]
fn faults_in_documents_of_one_long_line_are_told() {
    let space = "http://www.sbml.org/sbml/level3/version1/core";
    let blanks = " ".repeat(70_000);
    let compartment = "<listOfCompartments><compartment size=\"x\"/></listOfCompartments>";
    let sbml = format!("<sbml xmlns=\"{space}\" level=\"3\" version=\"1\"><model>{blanks}{compartment}</model></sbml>");
    let eml = format!("<eml name=\"a\">{blanks}<parameter id=\"a\"/></eml>");
    let unclosed = format!("<eml name=\"a\">{blanks}<parameter></eml>");
    for (text, part) in [(sbml, "[long:1:70129]"), (eml, "[long:1:70016]"), (unclosed, "[long:1:70026]")] {
        let error = equations::read(Arc::new(Source { name: "long".into(), text })).expect_err("a fault");
        let message = render(&error, Paint::Plain);
        assert!(message.contains(part) && message.len() < 2000, "{part}: {message}");
    }
}

/// Reads a damaged text in all ways; what is told has its place on characters of the text.
fn try_all(text: &str, whole: bool) {
    if let Err(trouble) = read(text) {
        assert!(text.get(trouble.at.clone()).is_some(), "{trouble:?}");
    }
    if whole && let Err(error) = equations::read(Arc::new(Source { name: "damaged".into(), text: text.to_owned() })) {
        assert!(!render(&error, Paint::Plain).is_empty());
    }
}

#[test]
fn no_truncation_and_no_changed_byte_makes_the_readers_panic() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for file in
        ["tests/messages/sbml/unknown_symbols.xml", "tests/messages/eml/events.eml", "tests/messages/eml/links.eml"]
    {
        let text = std::fs::read_to_string(root.join(file)).expect("a document");
        // With parts of every kind in front, so that damage meets them too.
        let text = format!("<!-- µ --><?a b?>\n{text}\n<!-- é -->").replacen(">\n", "><![CDATA[]]>&#32;<!-- -->\n", 2);
        for (at, _) in text.char_indices() {
            try_all(&text[..at], at % 11 == 0);
        }
        for (at, old) in text.char_indices() {
            for (number, new) in
                ["", "<", ">", "&", "\"", "'", "/", "=", "!", "?", "]", "µ", "\0", " "].iter().enumerate()
            {
                let changed = format!("{}{new}{}", &text[..at], &text[at + old.len_utf8()..]);
                try_all(&changed, (at + number) % 31 == 0);
            }
        }
    }
}
