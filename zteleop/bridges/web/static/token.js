// @ts-check
/** What lets this page in: it stands behind the # of the address that was printed. */

const KEY = "zteleop.token";

export const TOKEN = new URLSearchParams(location.hash.slice(1)).get("t") || sessionStorage.getItem(KEY) || "";
sessionStorage.setItem(KEY, TOKEN); // a page that is loaded anew keeps it; it stands in no address that is logged
history.replaceState(null, "", location.pathname);
