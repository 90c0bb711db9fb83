// Sphinx's search shows the words about what it found, for which it fetches each page; here they come from texts.js, so
// that they are there without a server too.
window.fetch = async (url) => ({
  text: async () => TEXTS[new URL(url, document.baseURI).href.slice(new URL('.', document.baseURI).href.length)] ?? '',
});
