import {chromium} from 'playwright-core';
const b=await chromium.launch({executablePath:'/usr/bin/chromium',args:['--headless','--no-sandbox','--use-angle=swiftshader','--enable-unsafe-swiftshader']});
const p=await b.newPage({viewport:{width:1280,height:800},colorScheme:'dark'});
p.on('console',m=>console.log(m.text()));
await p.goto('file:///tmp/vt/pyramid.html');
await p.waitForTimeout(1500);
for(const t of [0,0.1,0.11,0.1167,0.2,1,2]) { await p.evaluate(t=>avbdViewer.seek(t),t); await p.waitForTimeout(600); console.log(t, await p.evaluate(()=>[avbdViewer.time,avbdViewer.frame,JSON.stringify(avbdViewer.stats),...avbdViewer.poseOf(5)])); }
await p.screenshot({path:'/tmp/vt/dbg.png'});
await b.close();
